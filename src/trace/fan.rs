//! Fans: a lane that lags behind is walked alone, at 32 places at once.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::bundle::WIDTH;
use super::method::finest;
use super::packet::{Packet, Rules, patience, places, state};
use super::stride::SHYNESS;
use crate::field::Closure;
use crate::num::F64x32;

/// If no more lanes than this go on, those that lag behind are walked one by one, at 32 places at once.
pub(super) const STRAGGLERS: i64 = 3;

/// A lane lags behind after so many evaluations.
pub(super) const PATIENCE: i64 = 24;

/// How many evaluations a lane may take before it goes on by itself.
const MOST: i64 = 8192;

/// After so many evaluations a lane is stuck.
const STUCK_AFTER: i64 = 1024;

/// After how many evaluations gaps below which share of the tolerance are not looked into any more where ranges say nothing:
/// along the rim of a fractal, where a field that is far below the distance stays small for long.
const COARSER: [(i64, f64); 2] = [(2048, 1.0 / 16.0), (0, 1.0 / 1024.0)];

impl Packet {
    /// Whether a lane steps along close to a surface after a long way.
    #[inline(always)]
    pub(super) fn lags(&self, lane: usize, rules: &Rules) -> bool {
        let is_stepping = matches!(self.state[lane], state::MARCHING | state::PROBING);
        is_stepping
            && self.evaluations[lane] >= PATIENCE
            && self.departed[lane] != 0
            && self.last_value[lane].abs() <= 2.0 * rules.lipschitz * self.epsilon(lane, rules)
    }

    /// Lets a lane enclose the change of sign between its last sample and this one.
    fn enclose(&mut self, lane: usize, (t, value): (f64, f64)) {
        (self.high_t[lane], self.high_value[lane]) = (t, value);
        self.narrowings[lane] = 0;
        self.state[lane] = state::ENCLOSING;
        self.t[lane] = self.last_t[lane] + 0.5 * (t - self.last_t[lane]);
    }

    /// The tolerance at the last sample of a lane.
    #[inline(always)]
    fn epsilon(&self, lane: usize, rules: &Rules) -> f64 {
        let t = self.last_t[lane];
        let tolerance = rules.tolerance * (self.footprint[lane] + self.spread[lane] * t);
        tolerance.max(finest(self.size[lane], t))
    }
}

/// Walks one lane on at 32 places at once, until it gets away from the surface or finds it: every gap between two places
/// has to be known to be free, as every step, but for the shortest: those that rounding leaves, and where ranges say nothing those far
/// below the tolerance.
#[inline(always)]
pub(super) fn fan(packet: &mut Packet, lane: usize, value: &Closure<F64x32>, rules: &Rules) {
    let p = packet;
    let slope = rules.lipschitz;
    let (mut origin, mut direction) = ([[0.0; WIDTH]; 3], [[0.0; WIDTH]; 3]);
    for axis in 0..3 {
        origin[axis] = [p.origin[axis][lane]; WIDTH];
        direction[axis] = [p.direction[axis][lane]; WIDTH];
    }
    let limit = p.limit[lane];
    let (mut last_t, mut last) = (p.last_t[lane], p.last_value[lane]);
    // The gap that was not free in the fan before.
    let mut doubt = f64::INFINITY;
    while p.evaluations[lane] < MOST {
        let epsilon = p.epsilon(lane, rules);
        let free = last.abs() / slope;
        if last_t + free > limit {
            p.state[lane] = state::ARRIVED;
            p.t[lane] = last_t + free;
            return;
        }
        if free > 2.0 * epsilon {
            p.state[lane] = state::MARCHING;
            p.t[lane] = last_t + free;
            // What it knows of this surface says nothing of the next.
            p.patience[lane] = patience::SHORT;
            return;
        }
        let asked = p.evaluations[lane];
        let coarser = COARSER.iter().find(|(after, _)| asked > *after);
        let share = match coarser {
            Some((_, share)) if p.patience[lane] == patience::COARSE => *share,
            _ => 0.0,
        };
        if p.patience[lane] == patience::SHORT && asked > STUCK_AFTER {
            p.state[lane] = state::STUCK;
            p.t[lane] = (last_t + free.max(epsilon)).min(limit);
            return;
        }
        let shortest = finest(p.size[lane], last_t).max(share * epsilon);
        let width = if doubt < f64::INFINITY {
            doubt / WIDTH as f64
        } else {
            (SHYNESS * free).max(epsilon / WIDTH as f64)
        };
        let width = width.max(shortest);
        doubt = f64::INFINITY;
        let mut t = [0.0; WIDTH];
        for k in 0..WIDTH {
            let place = last_t + width * (k + 1) as f64;
            t[k] = if place < limit { place } else { limit };
        }
        let values = value(&places(&origin, &direction, &t)).0;
        p.evaluations[lane] += WIDTH as i64;
        // A change of sign within the tolerance needs no more, whatever lies before it.
        let beyond = (0..WIDTH).find(|k| (values[*k] < 0.0) != (last < 0.0));
        if let Some(k) = beyond.filter(|k| values[*k] != 0.0) {
            let gap = t[k] - last_t;
            let (change, sum) = ((values[k] - last).abs(), last.abs() + values[k].abs());
            let noise = 64.0 * f64::EPSILON * (p.size[lane] + t[k]) * slope;
            let is_sound = change <= slope * gap * (1.0 + 1e-9) + noise;
            let is_number = (0..k).all(|k| !values[k].is_nan());
            if is_sound && is_number && sum + slope * epsilon >= slope * gap * (1.0 - 1e-9) {
                if k > 0 {
                    (p.last_t[lane], p.last_value[lane]) = (t[k - 1], values[k - 1]);
                }
                p.enclose(lane, (t[k], values[k]));
                return;
            }
        }
        for k in 0..WIDTH {
            let now = values[k];
            let gap = t[k] - last_t;
            let sum = last.abs() + now.abs();
            let differs = now != 0.0 && (now < 0.0) != (last < 0.0);
            let noise = 64.0 * f64::EPSILON * (p.size[lane] + t[k]) * slope;
            if (now - last).abs() > slope * gap * (1.0 + 1e-9) + noise {
                p.state[lane] = state::REFUTED;
                p.t[lane] = t[k];
                return;
            }
            if now.is_nan() || now == 0.0 {
                p.state[lane] = state::SINGLE;
                p.t[lane] = t[k];
                return;
            }
            if differs && sum + slope * epsilon >= slope * gap * (1.0 - 1e-9) {
                p.enclose(lane, (t[k], now));
                return;
            }
            if differs || (sum < slope * gap * (1.0 - 1e-9) && gap > 1.5 * shortest) {
                // The next fan looks closer from here.
                doubt = gap;
                break;
            }
            (last_t, last) = (t[k], now);
            (p.last_t[lane], p.last_value[lane]) = (last_t, last);
            p.known[lane] = last_t + last.abs() / slope;
            p.rough[lane] = 0;
        }
        if last_t >= limit {
            p.state[lane] = state::ARRIVED;
            p.t[lane] = last_t + free.max(epsilon);
            return;
        }
    }
    p.state[lane] = state::SINGLE;
    p.t[lane] = last_t + (last.abs() / slope).max(p.epsilon(lane, rules));
}
