//! Cones: what holds the rays of each packet of a bundle, so that a part is asked only of the packets that may meet it.
//!
//! A packet's rays start within `width` of a mean origin o, and their directions differ by no more than `spread` from a mean
//! one, d. So after a way t they are within `width + spread t` of o + d t, and none comes into a ball about c of radius r as
//! long as, with q = c - o and R = r + width,
//!
//! ```text
//! |q - d t|^2 > (R + spread t)^2,   that is   (d.d - spread^2) t^2 - 2 (q.d + R spread) t + q.q - R^2 > 0
//! ```
//!
//! which all cones are asked at once. Source: Amanatides 1984, cones for beams of rays.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::analytic::Ball;
use super::bits::bits;
use super::bundle::{Bundle, WIDTH, fold, larger};
use super::vector::place;
use crate::field::Task;
use crate::num::BATCH;
use glam::DVec3;

/// How many packets a bundle has.
pub(super) const PACKETS: usize = BATCH / WIDTH;

/// A number for each of them.
type Each = [f64; PACKETS];

/// Room for rounding, as a share of what is rounded.
const ROOM: f64 = 1e-9;

/// Packets of a bundle, a bit for each.
pub(super) type Packets = u32;

/// All of them.
pub(super) const ALL: Packets = (1 << PACKETS) - 1;

/// The cones of the packets of a bundle.
#[derive(Default)]
#[repr(C, align(64))]
pub(super) struct Cones {
    /// The mean rays: their directions are not normalised.
    origin: [Each; 3],
    direction: [Each; 3],
    /// No origin is farther from the mean one.
    width: Each,
    /// No direction differs by more from the mean one.
    spread: Each,
    /// How far the farthest of the rays is still to be followed; negative where nothing is left to do.
    limit: Each,
}

/// Makes cones those of a bundle.
pub(super) struct Gather<'a> {
    /// The cones.
    pub cones: &'a mut Cones,
    /// The rays.
    pub bundle: &'a Bundle,
}

impl Task for Gather<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let (cones, b) = (self.cones, self.bundle);
        for (k, first) in (0..b.lanes()).step_by(WIDTH).enumerate() {
            let first = first.min(BATCH - WIDTH);
            let last = (first + WIDTH).min(b.count) - 1;
            let mut most = [0.0; 2];
            for (most, (columns, means)) in most.iter_mut().zip([
                (&b.origin, &mut cones.origin),
                (&b.direction, &mut cones.direction),
            ]) {
                let mean = 0.5 * (place(columns, first) + place(columns, last));
                let mut squares = [0.0; WIDTH];
                for lane in 0..WIDTH {
                    let square = place(columns, first + lane).distance_squared(mean);
                    // Lanes without a ray repeat the first of the bundle.
                    squares[lane] = if first + lane <= last { square } else { 0.0 };
                }
                *most = fold(&squares, 0.0, larger).sqrt() * (1.0 + ROOM);
                for axis in 0..3 {
                    means[axis][k] = mean[axis];
                }
            }
            [cones.width[k], cones.spread[k]] = most;
        }
    }
}

/// Finds how far the farthest rays of a bundle and of each of its packets are still to be followed; gives the first.
pub(super) struct Follow<'a> {
    /// The cones.
    pub cones: &'a mut Cones,
    /// The rays.
    pub bundle: &'a Bundle,
}

impl Task for Follow<'_> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let b = self.bundle;
        let mut farthest = -1.0;
        self.cones.limit = [-1.0; PACKETS];
        for (limit, ends) in self
            .cones
            .limit
            .iter_mut()
            .zip(b.limit[..b.lanes()].chunks_exact(WIDTH))
        {
            *limit = fold(ends, -1.0, larger);
            farthest = larger(*limit, farthest);
        }
        farthest
    }
}

/// Finds the packets whose rays may still meet a ball.
pub(super) struct Meeting<'a> {
    /// The cones.
    pub cones: &'a Cones,
    /// The ball.
    pub ball: Ball,
}

impl Task for Meeting<'_> {
    type Output = Packets;

    #[inline(always)]
    fn run(self) -> Packets {
        let (cones, Ball { centre, radius }) = (self.cones, self.ball);
        let radius = radius * (1.0 + ROOM) + 8.0 * f64::EPSILON * largest(centre);
        bits(|k| {
            let (q, d) = (centre - place(&cones.origin, k), place(&cones.direction, k));
            let (spread, reach) = (cones.spread[k], radius + cones.width[k]);
            let square = d.dot(d) - spread * spread;
            let linear = q.dot(d) + reach * spread;
            let distance = q.dot(q);
            let start = (distance - reach * reach) * square;
            let turn = if linear > 0.0 { linear * linear } else { 0.0 };
            let room = ROOM * (distance * square + turn);
            // Cones that are wider than they are long hold everything, and what is not a number is not known to miss.
            let is_aside = (start - turn > room) & (square > 0.0);
            // No ray goes farther than its own length, and all start within the width.
            let end = (cones.limit[k] + reach) * (1.0 + ROOM);
            let is_behind = distance > end * end;
            (cones.limit[k] >= 0.0) & !(is_aside | is_behind)
        })
    }
}

/// The largest coordinate, without its sign.
#[inline(always)]
fn largest(v: DVec3) -> f64 {
    larger(larger(v.x.abs(), v.y.abs()), v.z.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{Level, run_at};
    use crate::num::samples::random;
    use crate::trace::analytic::ClosedForm;
    use crate::trace::{Footprint, Ray, Rays};

    fn ray(seed: u64, k: u64, spread: f64) -> Ray {
        let place = |k: u64| {
            let x = |j: u64| 2.0 * random(seed * 65536 + k * 8 + j) - 1.0;
            DVec3::new(x(0), x(1), x(2))
        };
        // The rays of a packet go about the same way.
        let group = k / WIDTH as u64;
        Ray {
            origin: 3.0 * place(group) + 0.2 * spread * place(2 * k + 100),
            direction: (place(group + 50) + spread * place(2 * k + 101)).normalize(),
            t_max: if random(seed + k) < 0.2 {
                2.0
            } else {
                f64::INFINITY
            },
            footprint: Footprint {
                at_origin: 0.0,
                spread: 1e-3,
            },
        }
    }

    #[test]
    fn what_a_ray_meets_its_packet_may_meet() {
        let (mut met, mut missed) = (0, 0);
        for seed in 0..400u64 {
            let spread = random(seed).powi(3);
            let count = [256, 255, 32, 33, 1, 70][seed as usize % 6];
            let rays: Vec<Ray> = (0..count).map(|k| ray(seed, k, spread)).collect();
            let mut bundle = Bundle::new();
            let numbers: Vec<u32> = (0..count as u32).collect();
            let columns: Rays = rays.iter().collect();
            bundle.fill(&columns.columns(), &numbers);
            let (mut cones, level) = (Cones::default(), Level::best());
            let (cones, bundle) = (&mut cones, &bundle);
            run_at(level, Gather { cones, bundle });
            let farthest = run_at(level, Follow { cones, bundle });
            let ends = rays.iter().map(|ray| ray.t_max);
            assert_eq!(farthest, ends.fold(-1.0, f64::max));
            for k in 0..20 {
                let x = |j: u64| 3.0 * random(seed * 997 + k * 7 + j) - 1.5;
                let centre = DVec3::new(x(1), x(2), x(3));
                let radius = 0.5 * random(seed + k + 7);
                let ball = Ball { centre, radius };
                let packets = run_at(level, Meeting { cones, ball });
                assert_eq!(
                    packets >> count.div_ceil(WIDTH as u64),
                    0,
                    "there are no more"
                );
                for (i, ray) in rays.iter().enumerate() {
                    if ball.enter(ray).is_some_and(|hit| hit.t <= ray.t_max) {
                        met += 1;
                        assert_ne!(packets & (1 << (i / WIDTH)), 0, "seed {seed}, ray {i}");
                    }
                }
                let all = (1u32 << count.div_ceil(WIDTH as u64)) - 1;
                missed += (all & !packets).count_ones();
            }
        }
        assert!(met > 3_000 && missed > 10_000, "{met} {missed}");
    }
}
