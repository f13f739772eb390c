//! Tori in closed form: 32 rays at once.
//!
//! In units of the major radius, with the axis along y, a line p = q + u d, q the foot of the perpendicular from the centre,
//! is within r of the ring circle where
//!
//! ```text
//! F = Q - 2 rho < 0,   Q = u^2 + |q|^2 + 1 - r^2,   rho^2 = x^2 + z^2
//! ```
//!
//! and F (Q + 2 rho) = Q^2 - 4 rho^2 is a quartic without a cubic term, whose first root is found with certainty
//! (`quartic`); one step of Newton's method with F itself makes it as good as the ray. A line misses the torus if it misses
//! the ball or the slab around it, or passes within the hole as long as it is in both. A torus wider than its
//! ring (r > 1) has a second surface inside, which F does not have: from outside it comes later; rays that start inside
//! of such a torus are left open, as are all whose roots rounding decides.
//! Source: Hanrahan 1989 (in Glassner, An Introduction to Ray Tracing), for the quartic.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::analytic::{Ball, ClosedForm, U};
use super::bits::ones;
use super::bundle::{Bundle, WIDTH, larger, lesser};
use super::chord::Frame;
use super::cones::Packets;
use super::cut::{Found, Workshop, lines};
use super::packet::Lane;
use super::quartic::{Quartics, state};
use super::vector::place;
use crate::catalogue::{Similarity, Torus};
use crate::field::{Level, Task, run_at};
use crate::num::BATCH;
use glam::DVec3;

/// Tubes that are thinner or thicker than this, in major radii, are not taken: the quartic knows little of them.
const THICKNESS: [f64; 2] = [1e-3, 2.0];

/// By how much the solid around a torus is larger than it.
const ROOM: f64 = 1.0 + 1.0 / 64.0;

/// By how much the rounding of places may change the quartic, at most, for each unit of it: the sum of what its coefficients
/// change by is below 200, and twenty times that is as good as certain.
const DOUBT: f64 = 4096.0;

/// A torus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Its axis is y.
    frame: Frame,
    major: f64,
    /// The reciprocal of the major radius.
    inverse: f64,
    /// The minor radius in major ones.
    minor: f64,
    /// A ball around it.
    pub(super) around: Ball,
    /// How many units of rounding a value of the quartic may be off.
    doubt: f64,
}

/// A line in a ring's own coordinates, in units of the major radius.
struct Line {
    /// The origin.
    o: DVec3,
    direction: DVec3,
    /// The foot of the perpendicular from the centre.
    foot: DVec3,
    /// How far beyond the foot the origin lies.
    start: f64,
    /// A bound of the rounding of all that.
    noise: f64,
    /// Where it enters the solid around the ring, and where it leaves it, as seen from the foot.
    enter: f64,
    leave: f64,
    /// Whether it may meet the ring.
    is_close: bool,
}

impl Ring {
    /// The ring that a map makes of a torus; none if its tube is so thin or thick that rounding would decide too much.
    pub(super) fn placed(torus: &Torus, map: &Similarity) -> Option<Self> {
        let minor = torus.minor / torus.major;
        let major = torus.major * map.scale;
        let inverse = 1.0 / major;
        let is_ordinary = (THICKNESS[0]..=THICKNESS[1]).contains(&minor) && inverse.is_normal();
        let reach = 0.5 * (1.0 + minor);
        is_ordinary.then(|| Self {
            frame: Frame::new(map),
            major,
            inverse,
            minor,
            around: Ball {
                centre: DVec3::from_array(map.outside([0.0; 3])),
                radius: major * (1.0 + minor * ROOM),
            },
            // Its terms grow with the fourth power of lengths.
            doubt: DOUBT * if reach > 1.0 { reach.powi(4) } else { 1.0 },
        })
    }

    /// The outward unit normal at a point of the surface.
    pub(super) fn normal(&self, p: DVec3) -> DVec3 {
        let q = self.frame.place(p);
        let rho = (q.x * q.x + q.z * q.z).sqrt();
        let aside = (rho - self.major) / rho;
        let normal = DVec3::new(q.x * aside, q.y, q.z * aside);
        self.frame.outside(normal).normalize_or_zero()
    }

    #[inline(always)]
    fn line(&self, origin: DVec3, direction: DVec3) -> Line {
        let o = self.frame.place(origin) * self.inverse;
        let d = self.frame.turned(direction);
        let start = o.dot(d);
        let foot = o - d * start;
        let noise = self.frame.noise(origin, self.around.radius) * self.inverse;
        // Around the ring: a ball and a slab.
        let minor = self.minor * ROOM;
        let outer = 1.0 + minor;
        let half = (outer * outer - foot.length_squared()).sqrt();
        let slow = 1.0 / d.y;
        let (first, second) = ((-minor - foot.y) * slow, (minor - foot.y) * slow);
        // Not numbers where the line runs within a border of the slab, which then does not cut it.
        let (near, far) = (lesser(first, second), larger(first, second));
        let (enter, leave) = (larger(near, -half), lesser(far, half));
        // The distance from the axis is convex along a line.
        let hole = 1.0 - minor;
        let inside = |u: f64| {
            let (x, z) = (foot.x + d.x * u, foot.z + d.z * u);
            (hole > 0.0) & (x * x + z * z < hole * hole)
        };
        let passes = inside(enter) & inside(leave);
        let is_crossed = (half >= 0.0) & (enter <= leave) & (leave >= start);
        let is_fine = noise < 1e-3 * self.minor;
        Line {
            o,
            direction: d,
            foot,
            start,
            noise,
            enter,
            leave,
            is_close: (is_crossed & !passes) | !is_fine,
        }
    }

    /// Finds the hits of these rays of a bundle.
    pub(super) fn find(&self, bundle: &Bundle, rays: &[u32], level: Level, shop: &mut Workshop) {
        shop.found.clear();
        shop.open.clear();
        for rays in rays.chunks(WIDTH) {
            let cross = Cross {
                ring: self,
                bundle,
                rays,
            };
            let hits = run_at(level, cross);
            for (lane, ray) in rays.iter().enumerate() {
                match hits.state[lane] {
                    state::MISSED => {}
                    state::FOUND => shop.found.push(Found {
                        ray: *ray,
                        t: hits.t[lane],
                        error: hits.error[lane],
                        normal: DVec3::from_array(
                            [0, 1, 2].map(|axis: usize| hits.normal[axis][lane]),
                        ),
                    }),
                    _ => shop.open.push(*ray),
                }
            }
        }
    }
}

/// Finds which rays of a bundle may meet a ring before their limits.
pub(super) struct Near<'a> {
    /// The rays.
    pub bundle: &'a mut Bundle,
    /// The ring.
    pub ring: &'a Ring,
    /// The packets that may meet it.
    pub packets: Packets,
}

impl Task for Near<'_> {
    /// Whether any does.
    type Output = bool;

    #[inline(always)]
    fn run(self) -> bool {
        let (b, ring) = (self.bundle, self.ring);
        let mut count = 0;
        b.meets = [0; BATCH];
        for k in ones(self.packets) {
            let first = (k * WIDTH).min(BATCH - WIDTH);
            let mut is_met = false;
            for i in first..first + WIDTH {
                let (o, d) = (place(&b.origin, i), place(&b.direction, i));
                is_met |= ring.around.may_meet(o, d);
            }
            if !is_met {
                continue;
            }
            for i in first..first + WIDTH {
                let (o, d) = (place(&b.origin, i), place(&b.direction, i));
                let line = ring.line(o, d);
                // With room for the rounding of both.
                let end = (b.limit[i] * ring.inverse) * (1.0 + 1e-9) + line.start + 1e-6;
                let meets = line.is_close & (b.limit[i] >= 0.0) & (line.enter <= end);
                b.meets[i] = u8::from(meets);
                count += u64::from(meets);
            }
        }
        count > 0
    }
}

/// Finds the hits of up to 32 rays with a ring.
struct Cross<'a> {
    ring: &'a Ring,
    bundle: &'a Bundle,
    rays: &'a [u32],
}

/// The hits of 32 rays.
struct Hits {
    /// What was found, as in [`state`].
    state: [i64; WIDTH],
    t: Lane,
    error: Lane,
    /// Not normalised.
    normal: [Lane; 3],
}

impl Task for Cross<'_> {
    type Output = Hits;

    #[inline(always)]
    fn run(self) -> Hits {
        let mut lines = Lines::of(&self);
        let mut quartics = Quartics::new();
        if lines.prepare(&mut quartics) {
            lines.take_sides(&mut quartics);
        }
        quartics.solve();
        lines.hits(&quartics)
    }
}

/// 32 lines in a ring's own coordinates.
struct Lines<'a> {
    ring: &'a Ring,
    origin: [Lane; 3],
    direction: [Lane; 3],
    /// As of [`Line`].
    start: Lane,
    noise: Lane,
    /// Whether the origin lies within the solid around the ring.
    is_within: [i64; WIDTH],
}

impl<'a> Lines<'a> {
    /// The rays, in the scene's coordinates.
    #[inline(always)]
    fn of(cross: &Cross<'a>) -> Self {
        let zero = [0.0; WIDTH];
        let [a, b, c, d, e, f] = lines(cross.bundle, cross.rays);
        Self {
            ring: cross.ring,
            origin: [a, b, c],
            direction: [d, e, f],
            start: zero,
            noise: zero,
            is_within: [0; WIDTH],
        }
    }

    #[inline(always)]
    fn ray(&self, i: usize) -> (DVec3, DVec3) {
        (place(&self.origin, i), place(&self.direction, i))
    }

    /// Goes over to the ring's coordinates and writes down the quartics; gives whether any line starts close to the ring.
    #[inline(always)]
    fn prepare(&mut self, quartics: &mut Quartics) -> bool {
        let ring = self.ring;
        let minor = ring.minor * ring.minor;
        let mut within = 0;
        for i in 0..WIDTH {
            let (origin, direction) = self.ray(i);
            let line = ring.line(origin, direction);
            let (q, d) = (line.foot, line.direction);
            let k = q.length_squared() + 1.0 - minor;
            quartics.square[i] = 2.0 * k - 4.0 * (d.x * d.x + d.z * d.z);
            quartics.linear[i] = -8.0 * (q.x * d.x + q.z * d.z);
            quartics.constant[i] = k * k - 4.0 * (q.x * q.x + q.z * q.z);
            quartics.doubt[i] = ring.doubt * line.noise;
            quartics.side[i] = 1.0;
            let is_within = line.enter <= line.start;
            let from = if is_within { line.start } else { line.enter };
            quartics.from[i] = from;
            quartics.to[i] = line.leave;
            let begins = if line.is_close {
                state::FORWARD
            } else {
                state::MISSED
            };
            let is_known = (line.noise < 1e-3 * minor) & (line.leave > from);
            quartics.state[i] = if is_known { begins } else { state::OPEN };
            for (axis, (o, d)) in [(line.o.x, d.x), (line.o.y, d.y), (line.o.z, d.z)]
                .into_iter()
                .enumerate()
            {
                self.origin[axis][i] = o;
                self.direction[axis][i] = d;
            }
            self.start[i] = line.start;
            self.noise[i] = line.noise;
            self.is_within[i] = i64::from(is_within);
            within += i64::from(is_within);
        }
        within > 0
    }

    /// Finds on which side of the surface the lines are as soon as they leave their origins.
    #[inline(always)]
    fn take_sides(&self, quartics: &mut Quartics) {
        let ring = self.ring;
        for i in 0..WIDTH {
            let (o, d) = self.ray(i);
            let Place { value, slope, .. } = ring.at(o, d);
            let noise = ring.value_noise(self.noise[i]);
            let is_on = value.abs() <= noise;
            // Of what starts on the surface and nearly along it, rounding decides where it goes.
            let is_flat = slope * slope <= ring.doubt * noise;
            let is_outside = if is_on { slope > 0.0 } else { value > 0.0 };
            let is_within = self.is_within[i] != 0;
            let is_inside = !is_outside & is_within;
            let is_open = ((is_on & is_flat) | (!is_outside & (ring.minor > 1.0))) & is_within;
            quartics.side[i] = if is_inside { -1.0 } else { 1.0 };
            quartics.state[i] = if is_open {
                state::OPEN
            } else {
                quartics.state[i]
            };
        }
    }

    /// Makes hits of the roots.
    #[inline(always)]
    fn hits(&self, quartics: &Quartics) -> Hits {
        let (ring, zero) = (self.ring, [0.0; WIDTH]);
        let mut hits = Hits {
            state: quartics.state,
            t: zero,
            error: zero,
            normal: [zero; 3],
        };
        for i in 0..WIDTH {
            let (o, d) = self.ray(i);
            let way = quartics.u[i] - self.start[i];
            let Place {
                value,
                slope,
                gradient,
            } = ring.at(o + d * way, d);
            let step = -value / slope;
            let t = (way + step) * ring.major;
            let noise = ring.value_noise(self.noise[i]);
            let error = noise / slope.abs() * ring.major + 4.0 * U * t.abs();
            // What starts on the surface leaves it first; a line that starts as close as that is left open.
            let is_sound = (step.abs() < 1e-4 * ring.minor) & (t > 2.0 * error);
            // Lines that start inside come out somewhere.
            let is_lost = (quartics.side[i] < 0.0) & (quartics.state[i] == state::MISSED);
            let is_open = ((quartics.state[i] == state::FOUND) & !is_sound) | is_lost;
            hits.state[i] = if is_open {
                state::OPEN
            } else {
                quartics.state[i]
            };
            hits.t[i] = t;
            hits.error[i] = error;
            let normal = ring.frame.outside(gradient);
            hits.normal[0][i] = normal.x;
            hits.normal[1][i] = normal.y;
            hits.normal[2][i] = normal.z;
        }
        hits
    }
}

impl Ring {
    /// F at a place and its derivative along a direction.
    #[inline(always)]
    fn at(&self, p: DVec3, direction: DVec3) -> Place {
        let rho = (p.x * p.x + p.z * p.z).sqrt();
        let aside = rho - 1.0;
        let value = aside * aside + p.y * p.y - self.minor * self.minor;
        let scale = aside / rho;
        let gradient = DVec3::new(p.x * scale, p.y, p.z * scale);
        Place {
            value,
            slope: 2.0 * gradient.dot(direction),
            gradient,
        }
    }

    /// A bound of the error of F near the surface, where coordinates are off by `noise`.
    #[inline(always)]
    fn value_noise(&self, noise: f64) -> f64 {
        8.0 * self.minor * noise
    }
}

/// F at a place.
struct Place {
    value: f64,
    /// The derivative along the line.
    slope: f64,
    /// Half the gradient.
    gradient: DVec3,
}
