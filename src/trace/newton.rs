//! Newton's method from the safe side in lanes: 32 rays come to a convex shape together.
//!
//! As `method/convex.rs`, which has the sources; a ray that starts inside is handed over to it.

use super::bundle::WIDTH;
use super::method::finest;
use super::packet::{Lane, Packet, Rules, state};
use crate::field::{Closure, Task};
use crate::num::{Dual, F64x32, Lanes, Vec3};

/// Walks the lanes of a packet by tangents until each has found something or has missed.
pub(super) struct Newton<'a> {
    /// The lanes.
    pub packet: &'a mut Packet,
    /// The field with its derivative along the rays.
    pub slope: &'a Closure<Dual<F64x32, 1>>,
    /// What it goes by.
    pub rules: &'a Rules,
}

impl Task for Newton<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        loop {
            let directions = self.packet.direction;
            let field = (self.slope)(&along(self.packet, &self.packet.t, &directions));
            if step(self.packet, &field.value.0, &field.partial[0].0, self.rules) == 0 {
                return;
            }
        }
    }
}

/// The places of all lanes at the distances `t`, moving in these directions.
#[inline(always)]
fn along(packet: &Packet, t: &Lane, directions: &[Lane; 3]) -> Vec3<Dual<F64x32, 1>> {
    let [u, v, w] = *directions;
    let place = packet.places(t);
    let moving = |value: F64x32, rate: Lane| Dual::new(value, [Lanes(rate)]);
    Vec3::new(moving(place.x, u), moving(place.y, v), moving(place.z, w))
}

/// Lets every lane observe its value and slope; gives how many go on.
#[inline(always)]
fn step(packet: &mut Packet, values: &Lane, slopes: &Lane, rules: &Rules) -> i64 {
    let p = packet;
    let max_steps = i64::from(rules.max_steps);
    let mut going = 0;
    for i in 0..WIDTH {
        let (value, slope, t) = (values[i], slopes[i], p.t[i]);
        let is_active = p.state[i] == state::FRESH;
        let first = p.steps[i] == 0;
        let steps = p.steps[i] + 1;
        let is_rare =
            value.is_nan() || slope.is_nan() || steps > max_steps || (first && value <= 0.0);
        let leaves = value > 0.0 && slope >= 0.0;
        let step = -value / slope;
        let rounding = finest(p.size[i], t);
        let is_there = value <= 0.0 || step <= rounding;
        let next = t + step;
        let becomes = if is_rare {
            state::SINGLE
        } else if leaves {
            state::ARRIVED
        } else if is_there {
            state::HIT
        } else if next > p.end[i] {
            state::ARRIVED
        } else {
            state::FRESH
        };
        let noise = 64.0 * f64::EPSILON * (p.size[i] + t) * rules.lipschitz;
        let by_noise = noise / slope.abs();
        let by_step = step.abs();
        let error = if by_noise > by_step {
            by_noise
        } else {
            by_step
        };
        let epsilon = rules.tolerance * (p.footprint[i] + p.spread[i] * t);
        let error = if error > epsilon { epsilon } else { error };
        let error = if error > rounding { error } else { rounding };
        p.error[i] = if is_active { error } else { p.error[i] };
        let goes = is_active && becomes == state::FRESH;
        p.state[i] = if is_active { becomes } else { p.state[i] };
        p.t[i] = if goes { next } else { t };
        p.steps[i] += i64::from(is_active);
        p.evaluations[i] += i64::from(is_active);
        going += i64::from(goes);
    }
    going
}
