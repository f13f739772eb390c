//! Certified sphere tracing in lanes: 32 rays take their steps together.
//!
//! Each lane is the machine of `method/certified.rs` in short: inside of a step that went farther than is known to be free it
//! remembers one far end, not a stack of them. A lane that runs out of steps or meets what is not a number is handed over to that machine. A change of sign is enclosed between two
//! neighbours on a grid of a power of two, so that a hit has the same bits whichever way a ray came near. Sources: as
//! there; Hart 1996.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::bundle::WIDTH;
use super::fan::{STRAGGLERS, fan};
use super::method::finest;
use super::packet::{Lane, Packet, Rules, places, state};
use crate::field::{Closure, Task};
use crate::num::{F64x32, Number};

/// A step is lengthened to this share of what the trend of the field allows, times two: the published factor is 2. Source:
/// Ban and Valasek 2023.
pub(super) const SHYNESS: f64 = 1.9;

/// The field of a ray that leaves a surface rises at most by this share of its constant, as far as steps count on it.
const LARGEST_TREND: f64 = 0.875;

/// More narrowings than halving needs from any width to rounding; and how many samples may be taken inside of one step.
const MAX_NARROWINGS: i64 = 200;

/// Walks the lanes of a packet until each has found something or has come to the end of its stretch, or until few are left.
pub(super) struct Stride<'a> {
    /// The lanes.
    pub packet: &'a mut Packet,
    /// The field.
    pub value: &'a Closure<F64x32>,
    /// What it goes by.
    pub rules: &'a Rules,
    /// It ends once no more lanes than this go on.
    pub few: i64,
}

impl Task for Stride<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self {
            packet,
            value,
            rules,
            few,
        } = self;
        loop {
            let values = value(&places(&packet.origin, &packet.direction, &packet.t));
            let going = step(packet, &values.0, rules);
            if going <= few {
                return;
            }
            if going <= STRAGGLERS {
                for lane in 0..WIDTH {
                    if packet.lags(lane, rules) {
                        fan(packet, lane, value, rules);
                    }
                }
            }
        }
    }
}

/// How many lanes go through a step at once; where none of them goes on, the step is left out.
const GROUP: usize = 8;

/// Lets every lane observe its value; gives how many go on.
#[inline(always)]
fn step(packet: &mut Packet, values: &Lane, rules: &Rules) -> i64 {
    let mut going = 0;
    for first in (0..WIDTH).step_by(GROUP) {
        let mut is_idle = true;
        for i in first..first + GROUP {
            let state = packet.state[i];
            is_idle &= (state == state::IDLE) | (state >= state::ARRIVED);
        }
        if !is_idle {
            going += step_group(packet, values, rules, first);
        }
    }
    going
}

/// As [`step`], for the lanes from `first` on.
#[inline(always)]
fn step_group(packet: &mut Packet, values: &Lane, rules: &Rules, first: usize) -> i64 {
    let p = packet;
    let slope = rules.lipschitz;
    let inverse = 1.0 / slope;
    let max_steps = i64::from(rules.max_steps);
    // Where any hit will do, a change of sign needs no more.
    let careless = if rules.any { f64::INFINITY } else { 0.0 };
    let mut going = 0;
    for i in first..first + GROUP {
        let (now, t, was) = (values[i], p.t[i], p.state[i]);
        let (last_t, last_value) = (p.last_t[i], p.last_value[i]);
        let (high_t, high_value) = (p.high_t[i], p.high_value[i]);
        let is_fresh = was == state::FRESH;
        let is_probing = was == state::PROBING;
        let is_enclosing = was == state::ENCLOSING;
        let has_last = was == state::MARCHING || is_probing;
        let is_marching = is_fresh || has_last;
        let contradicts = is_fresh && now * p.side[i] <= 0.0 && p.side[i] != 0.0;
        let now = if contradicts {
            p.side[i] * f64::MIN_POSITIVE
        } else {
            now
        };

        // What the sample says beside the last one.
        let noise = 64.0 * f64::EPSILON * (p.size[i] + t) * slope;
        let width = t - last_t;
        let change = (now - last_value).abs();
        let is_refuted = has_last && change > slope * width * (1.0 + 1e-9) + noise;
        let differs = now != 0.0 && (now < 0.0) != (last_value < 0.0);
        let rounding = finest(p.size[i], t);
        let tolerance = rules.tolerance * (p.footprint[i] + p.spread[i] * t);
        let sum = last_value.abs() + now.abs();
        let is_free = sum >= slope * width * (1.0 - 1e-9) || width <= rounding;
        let has_departed = p.departed[i] != 0;
        let goes_back = has_last && has_departed && !differs && !is_free;
        // A change of sign may hide a surface before it where more than the tolerance is not known to be free.
        let is_enough = sum + slope * tolerance + careless >= slope * width * (1.0 - 1e-9);
        let is_crossing = has_last && differs && (is_enough || !has_departed);
        let retreats = has_last && differs && !is_crossing;
        // And beside the far end of a step that is doubted.
        let rest = high_t - t;
        let sum = now.abs() + high_value.abs();
        let rest_is_free = sum >= slope * rest * (1.0 - 1e-9) || rest <= rounding;
        let halves = is_probing && !goes_back && !rest_is_free;
        let leaps = is_probing && !goes_back && rest_is_free;

        // On from here, or from the far end of that step.
        let here_t = if leaps { high_t } else { t };
        let here = if leaps { high_value } else { now };
        let tolerance = rules.tolerance * (p.footprint[i] + p.spread[i] * here_t);
        let epsilon = if tolerance > rounding {
            tolerance
        } else {
            rounding
        };
        let free = here.abs() * inverse;
        let is_at_end = here_t >= p.limit[i];
        let has_arrived = is_at_end || here_t + free > p.limit[i];
        let reach = free.max(p.size[i]).max(p.footprint[i]) * (1u64 << 30) as f64;
        let is_first = p.steps[i] == 0;
        let far = if is_first && rules.is_endless {
            reach
        } else {
            p.far[i]
        };
        let spent = p.steps[i] + 1 >= max_steps || p.narrowings[i] >= MAX_NARROWINGS;
        let is_rare = now.is_nan() || spent || here_t > far;
        let is_on_surface = here == 0.0 || (!has_departed && now.abs() <= noise);
        let is_inside = here_t + epsilon < p.limit[i] || is_at_end;
        let short = if is_inside {
            here_t + epsilon
        } else {
            p.limit[i]
        };
        // As far as the field may be free if it goes on changing as it did since the last sample.
        let way = slope * (here_t - last_t);
        let rise = here.abs() - last_value.abs();
        let least = (1.0 - LARGEST_TREND) * way;
        let share = if way - rise > least {
            way - rise
        } else {
            least
        };
        let factor = SHYNESS * way / share;
        let may_leap = has_last && has_departed && factor > 1.0;
        let leap = free * if may_leap { factor } else { 1.0 };
        let is_inside = here_t + leap < p.limit[i] || has_arrived;
        let relaxed = if is_inside { here_t + leap } else { p.limit[i] };
        let relaxed = if has_arrived { here_t + free } else { relaxed };
        let next = if leap >= epsilon { relaxed } else { short };
        let next = if halves { t + 0.5 * rest } else { next };
        let next = if goes_back {
            last_t + 0.5 * width
        } else {
            next
        };
        let last_free = last_value.abs() * inverse;
        let retreat = if last_free > epsilon {
            last_free
        } else {
            epsilon
        };
        let next = if retreats { last_t + retreat } else { next };
        let marched = if is_rare {
            state::SINGLE
        } else if is_refuted {
            state::REFUTED
        } else if is_crossing {
            state::ENCLOSING
        } else if goes_back || halves {
            state::PROBING
        } else if retreats {
            state::MARCHING
        } else if has_arrived {
            state::ARRIVED
        } else if is_on_surface && is_fresh {
            state::FRESH
        } else {
            state::MARCHING
        };
        let ends = marched == state::SINGLE || marched == state::REFUTED;

        // Enclosing: the new sample takes the place of the end with its sign.
        let is_low = now != 0.0 && (now < 0.0) == (last_value < 0.0);
        let begins = is_marching && marched == state::ENCLOSING;
        let encloses = is_enclosing || begins;
        let low_t = if is_enclosing && is_low { t } else { last_t };
        let low_value = if is_enclosing && is_low {
            now
        } else {
            last_value
        };
        let is_new_high = begins || !is_low;
        let top_t = if is_new_high { t } else { high_t };
        let top_value = if is_new_high { now } else { high_value };
        let span = top_t - low_t;
        // Both are powers of two, so their products are exact.
        let (grid, finer) = (p.grid[i], p.finer[i]);
        let widest = grid + careless;
        let starts_anew = is_marching && (begins || marched == state::MARCHING);
        let narrowings = if starts_anew { 0 } else { p.narrowings[i] };
        let is_done = top_value == 0.0 || span <= widest || narrowings >= MAX_NARROWINGS;
        let secant = low_t + low_value / (low_value - top_value) * span;
        let middle = low_t + 0.5 * span;
        let is_within = secant >= low_t && secant <= top_t;
        let inner = if narrowings & 3 == 3 || !is_within {
            middle
        } else {
            secant
        };
        let below = Number::floor(inner * finer) * grid;
        let above = (Number::floor(low_t * finer) + 1.0) * grid;
        let aligned = if below > low_t { below } else { above };
        let probe = if aligned < top_t { aligned } else { middle };
        let narrowed = if is_done {
            state::HIT
        } else {
            state::ENCLOSING
        };

        // What becomes of the lane.
        let becomes = if is_marching { marched } else { was };
        let becomes = if encloses { narrowed } else { becomes };
        let sets_last = is_marching && !ends && !goes_back && !retreats && !is_on_surface;
        let last_t = if sets_last { here_t } else { last_t };
        let last_value = if sets_last { here } else { last_value };
        // The far end of a step that is doubted.
        let is_doubted = is_marching && goes_back;
        let high_t = if is_doubted { t } else { high_t };
        let high_value = if is_doubted { now } else { high_value };
        p.state[i] = becomes;
        p.last_t[i] = if encloses { low_t } else { last_t };
        p.last_value[i] = if encloses { low_value } else { last_value };
        p.high_t[i] = if encloses { top_t } else { high_t };
        p.high_value[i] = if encloses { top_value } else { high_value };
        let moved = if is_marching && !ends { next } else { t };
        p.t[i] = if encloses { probe } else { moved };
        let sign = if here < 0.0 { -1.0 } else { 1.0 };
        p.side[i] = if sets_last { sign } else { p.side[i] };
        p.has_last[i] = if is_marching {
            i64::from(has_last || sets_last)
        } else {
            p.has_last[i]
        };
        p.far[i] = far;
        p.departed[i] |= i64::from(is_marching && free > epsilon);
        p.steps[i] += i64::from(is_fresh || was == state::MARCHING);
        p.evaluations[i] += i64::from(is_marching || is_enclosing);
        p.narrowings[i] = narrowings + i64::from(encloses || becomes == state::PROBING);
        going += i64::from(becomes < state::ARRIVED && becomes != state::IDLE);
    }
    going
}
