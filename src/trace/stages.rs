//! Stages: the way through a part in stretches, each with the field that holds there.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::beam::Beam;
use super::bundle::{Bundle, WIDTH};
use super::packet::Rules;
use super::part::Marched;
use crate::field::{Closure, Thicket, Thinned};
use crate::num::{F64x32, Lanes, Vec3};

/// Below this many rays it is not worth to thin out a combination.
const FEW: usize = 8;

/// A stretch of the way through a part, with the field that holds there.
pub(super) struct Stage {
    pub from: f64,
    pub to: f64,
    /// On which side the rays are before it, if what lies between it and the stage before is free.
    pub before: Option<f64>,
    pub value: Closure<F64x32>,
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
        left: None,
    };
    let ends = rays.iter().map(|ray| {
        let ray = *ray as usize;
        (bundle.enter[ray], bundle.leave[ray])
    });
    let (from, to) = ends.fold((f64::INFINITY, 0.0f64), |(a, b), (enter, leave)| {
        (a.min(enter), b.max(leave))
    });
    let Some(thicket) = marched.thicket.as_ref() else {
        return vec![whole()];
    };
    let is_wide = beam.radius(from) > 0.25 * (to - from);
    if rays.len() < FEW || !to.is_finite() || to <= from || is_wide {
        return vec![whole()];
    }
    thinned_stages(thicket, beam, rules, (from, to))
}

/// The stages from `from` to `to`, by balls along the beam; those that are surely free are left out.
fn thinned_stages(
    thicket: &Thicket,
    beam: &Beam,
    rules: &Rules,
    (from, to): (f64, f64),
) -> Vec<Stage> {
    let width = (to - from) / WIDTH as f64;
    let border = |k: usize| from + width * k as f64;
    let mut centres = [[0.0; WIDTH]; 3];
    let mut radii = [0.0; WIDTH];
    // Room for steps that begin in one ball and end in the next, and for the rounding of borders.
    let room = 1e-9 * (to + rules.reach);
    for k in 0..WIDTH {
        let (centre, radius) = beam.ball(border(k), border(k + 1));
        radii[k] = radius + room;
        (0..3).for_each(|axis| centres[axis][k] = centre[axis]);
    }
    let [x, y, z] = centres.map(Lanes);
    let values = thicket.values(&Vec3::new(x, y, z));
    let joined = thicket.joined(&values);

    let noise = 64.0 * f64::EPSILON * (rules.reach + to) * rules.lipschitz;
    let change = |radius: f64| rules.lipschitz * radius * (1.0 + 1e-9) + noise;
    let is_open = |k: usize| joined.0[k].abs() <= change(radii[k]);
    if !(0..WIDTH).any(is_open) {
        return Vec::new();
    }
    let sifted = thicket.sifted(&values, &Lanes(radii), noise);
    let mut stages: Vec<Stage> = Vec::new();
    let mut free = Some(1.0).filter(|_| from > 0.0);
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
            last.to = border(k + 1);
            continue;
        }
        let left = thicket.thinned(&sifted, k);
        first = k;
        stages.push(Stage {
            from: border(k),
            to: border(k + 1),
            before: free.take(),
            value: thicket.value(&left),
            left: Some(left),
        });
    }
    stages
}
