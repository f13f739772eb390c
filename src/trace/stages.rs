//! Stages: the way through a part in stretches, each with the field that holds there.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::beam::Beam;
use super::bundle::{Bundle, WIDTH};
use super::packet::{Lane, Rules};
use super::part::Marched;
use crate::field::{Closure, Task, Thicket, Thinned, run_at};
use crate::num::{BATCH, F32x32, F64x32, Lanes, Vec3};

/// How many rays are looked at side by side.
const LANES: usize = 8;

/// Below this many rays it is not worth to thin out a combination.
const FEW: usize = 8;

/// A stretch of the way through a part, with the field that holds there.
pub(super) struct Stage {
    pub from: f64,
    pub to: f64,
    /// On which side the rays are before it, if what lies between it and the stage before is free.
    pub before: Option<f64>,
    pub value: Closure<F64x32>,
    /// The same for scouts, if there are any.
    pub short: Option<Closure<F32x32>>,
    pub left: Option<Thinned>,
}

/// The stages of the way through a part.
pub(super) fn stages(
    marched: &Marched,
    beam: &Beam,
    rules: &Rules,
    bundle: &Bundle,
    rays: &[u32],
) -> Vec<Stage> {
    let whole = || Stage {
        from: 0.0,
        to: f64::INFINITY,
        before: None,
        value: marched.value.clone(),
        short: marched.short().map(|short| short.value.clone()),
        left: None,
    };
    let Some(thicket) = marched.thicket.as_ref() else {
        return vec![whole()];
    };
    let (from, to) = run_at(thicket.level(), Ends { bundle, rays });
    let is_wide = beam.radius(from) > 0.25 * (to - from);
    if rays.len() < FEW || !to.is_finite() || to <= from || is_wide {
        return vec![whole()];
    }
    let balls = Balls::along(beam, marched, rules, (from, to));
    thinned_stages(thicket, &balls, marched, rules)
}

/// Where the first of some rays enters the region, and where the last leaves it.
struct Ends<'a> {
    bundle: &'a Bundle,
    rays: &'a [u32],
}

impl Task for Ends<'_> {
    type Output = (f64, f64);

    #[inline(always)]
    fn run(self) -> (f64, f64) {
        let (mut from, mut to) = ([f64::INFINITY; LANES], [0.0; LANES]);
        for rays in self.rays.chunks(LANES) {
            for lane in 0..LANES {
                let ray = rays[if lane < rays.len() { lane } else { 0 }] as usize % BATCH;
                let (enter, leave) = (self.bundle.enter[ray], self.bundle.leave[ray]);
                from[lane] = if enter < from[lane] {
                    enter
                } else {
                    from[lane]
                };
                to[lane] = if leave > to[lane] { leave } else { to[lane] };
            }
        }
        (
            from.into_iter().fold(f64::INFINITY, f64::min),
            to.into_iter().fold(0.0, f64::max),
        )
    }
}

/// Balls one after the other that hold a beam.
struct Balls {
    from: f64,
    /// How long the stretch is that each of them holds.
    width: f64,
    centres: Vec3<F64x32>,
    radii: Lane,
    /// How much of a value is noise.
    noise: f64,
}

impl Balls {
    /// The balls that hold a beam from `from` to `to`.
    fn along(beam: &Beam, marched: &Marched, rules: &Rules, (from, to): (f64, f64)) -> Self {
        let width = (to - from) / WIDTH as f64;
        let mut centres = [[0.0; WIDTH]; 3];
        let mut radii = [0.0; WIDTH];
        // Room for steps that begin in one ball and end in the next, and for the rounding of borders.
        let scouts = marched.short().map_or(0.0, |short| short.off);
        let room = 1e-9 * (to + rules.reach) + scouts;
        for k in 0..WIDTH {
            let ends = [k, k + 1].map(|k| from + width * k as f64);
            let (centre, radius) = beam.ball(ends[0], ends[1]);
            // Where the constant holds only in the region, it says something from places in it alone.
            let is_told = !marched.is_regional || marched.region.contains(centre.to_array());
            radii[k] = if is_told {
                radius + room
            } else {
                f64::INFINITY
            };
            (0..3).for_each(|axis| centres[axis][k] = centre[axis]);
        }
        let [x, y, z] = centres.map(Lanes);
        Self {
            from,
            width,
            centres: Vec3::new(x, y, z),
            radii,
            noise: 64.0 * f64::EPSILON * (rules.reach + to) * rules.lipschitz,
        }
    }

    /// Where ball number `k` begins, and the one before it ends.
    fn border(&self, k: usize) -> f64 {
        self.from + self.width * k as f64
    }

    /// Whether a surface may lie in ball number `k`, at whose centre the field has this value.
    fn is_open(&self, k: usize, value: f64, rules: &Rules) -> bool {
        let change = rules.lipschitz * self.radii[k] * (1.0 + 1e-9) + self.noise;
        value.abs() <= change
    }
}

/// The stages along a beam, each with what is left of a combination; those that are surely free are left out.
fn thinned_stages(
    thicket: &Thicket,
    balls: &Balls,
    marched: &Marched,
    rules: &Rules,
) -> Vec<Stage> {
    let values = thicket.values(&balls.centres);
    let joined = thicket.joined(&values);
    let is_open = |k: usize| balls.is_open(k, joined.0[k], rules);
    if !(0..WIDTH).any(is_open) {
        return Vec::new();
    }
    let sifted = thicket.sifted(&values, &Lanes(balls.radii), balls.noise);
    let mut stages: Vec<Stage> = Vec::new();
    let mut free = Some(1.0).filter(|_| balls.from > 0.0);
    // The ball in which the last stage begins.
    let mut first = 0;
    for k in 0..WIDTH {
        let (low, high) = (sifted.reach.low.0[k], sifted.reach.high.0[k]);
        if !is_open(k) || low > 0.0 || high < 0.0 {
            free = Some(joined.0[k].signum());
            continue;
        }
        let is_next = free.is_none();
        if let Some(last) = stages.last_mut()
            && is_next
            && sifted.is_same(first, k)
        {
            last.to = balls.border(k + 1);
            continue;
        }
        let left = thicket.thinned(&sifted, k);
        first = k;
        stages.push(Stage {
            from: balls.border(k),
            to: balls.border(k + 1),
            before: free.take(),
            value: thicket.value(&left),
            short: marched.short().map(|_| thicket.short(&left)),
            left: Some(left),
        });
    }
    stages
}
