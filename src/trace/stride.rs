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
use super::packet::{Lane, Packet, Rules, count, places, state};
use crate::field::{Closure, Task};
use crate::num::{F64x32, Number};

/// A step is lengthened to this share of what the trend of the field allows, times two: the published factor is 2. Source:
/// Ban and Valasek 2023.
pub(super) const SHYNESS: f64 = 1.9;

/// The field of a ray that leaves a surface rises at most by this share of its constant, as far as steps count on it.
pub(super) const LARGEST_TREND: f64 = 0.875;

/// A lane is left to scouts if its way is free for more tolerances than this.
const AWAY: f64 = 1.0;

/// More narrowings than halving needs from any width to rounding; and how many samples may be taken inside of one step.
const MAX_NARROWINGS: i64 = 200;

/// After so many evaluations lanes that lag behind are walked one by one, however many go on.
const ROUNDS: u32 = 256;

/// Walks the lanes of a packet until each has found something or has come to the end of its stretch, or until few are left.
pub(super) struct Stride<'a> {
    /// The lanes.
    pub packet: &'a mut Packet,
    /// The field.
    pub value: &'a Closure<F64x32>,
    /// What it goes by.
    pub rules: &'a Rules,
    /// Lanes with a larger value than that, and far from it by some tolerances, are left to scouts; infinite if there are none.
    pub scouted: f64,
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
            scouted,
            few,
        } = self;
        let inverse = 1.0 / rules.lipschitz;
        if count(&packet.state, state::is_going) <= few {
            return;
        }
        for round in 1u32.. {
            let values = value(&places(&packet.origin, &packet.direction, &packet.t));
            let going = step(packet, &values.0, rules, inverse, scouted);
            if going <= few {
                return;
            }
            if going <= STRAGGLERS || round.is_multiple_of(ROUNDS) {
                for lane in 0..WIDTH {
                    if packet.lags(lane, rules) {
                        fan(packet, lane, value, rules);
                    }
                }
            }
        }
    }
}

/// How many lanes go through a step at once. What none of them does is left out.
const GROUP: usize = 8;

/// Lets every lane observe its value, given the reciprocal of the constant; gives how many go on.
#[inline(always)]
fn step(packet: &mut Packet, values: &Lane, rules: &Rules, inverse: f64, scouted: f64) -> i64 {
    for first in (0..WIDTH).step_by(GROUP) {
        let mut marches = false;
        for i in first..first + GROUP {
            marches |= state::is_marching(packet.state[i]);
            packet.evaluations[i] += i64::from(state::is_going(packet.state[i]));
        }
        if marches {
            if rules.is_endless {
                reach(packet, values, inverse, first);
            }
            march(packet, values, rules, inverse, scouted, first);
        }
        let mut encloses = false;
        for i in first..first + GROUP {
            encloses |= packet.state[i] == state::ENCLOSING;
        }
        if encloses {
            narrow(packet, values, rules, first);
        }
    }
    count(&packet.state, state::is_going)
}

/// The value of a lane, given the side of the surface that it is known to be on.
#[inline(always)]
fn observed(p: &Packet, values: &Lane, i: usize) -> f64 {
    let (now, side) = (values[i], p.side[i]);
    if (p.state[i] == state::FRESH) & (now * side <= 0.0) & (side != 0.0) {
        side * f64::MIN_POSITIVE
    } else {
        now
    }
}

/// How far the lanes from `first` on are followed through a shape without end: found from their first values.
#[inline(always)]
fn reach(p: &mut Packet, values: &Lane, inverse: f64, first: usize) {
    for i in first..first + GROUP {
        let free = observed(p, values, i).abs() * inverse;
        let size = free.max(p.size[i]).max(p.footprint[i]);
        let is_first = (p.steps[i] == 0) & (p.state[i] == state::FRESH);
        p.far[i] = if is_first {
            size * (1u64 << 30) as f64
        } else {
            p.far[i]
        };
    }
}

/// A step of the lanes from `first` on that march; those that meet a change of sign begin to enclose it.
#[inline(always)]
fn march(p: &mut Packet, values: &Lane, rules: &Rules, inverse: f64, scouted: f64, first: usize) {
    let slope = rules.lipschitz;
    let max_steps = i64::from(rules.max_steps);
    // Where any hit will do, a change of sign needs no more.
    let careless = if rules.any { f64::INFINITY } else { 0.0 };
    for i in first..first + GROUP {
        let now = observed(p, values, i);
        let (t, was) = (p.t[i], p.state[i]);
        let (last_t, last_value) = (p.last_t[i], p.last_value[i]);
        let (high_t, high_value) = (p.high_t[i], p.high_value[i]);
        let is_fresh = was == state::FRESH;
        let is_probing = was == state::PROBING;
        let is_stepping = is_fresh || was == state::MARCHING;
        let has_last = was == state::MARCHING || is_probing;
        let is_marching = is_fresh || has_last;

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
        let limit = p.limit[i];
        let is_at_end = here_t >= limit;
        let has_arrived = is_at_end || here_t + free > limit;
        let spent = p.steps[i] + 1 >= max_steps || p.narrowings[i] >= MAX_NARROWINGS;
        let is_rare = now.is_nan() || spent || here_t > p.far[i];
        let is_on_surface = here == 0.0 || (!has_departed && now.abs() <= noise);
        let is_inside = here_t + epsilon < limit || is_at_end;
        let short = if is_inside { here_t + epsilon } else { limit };
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
        let is_inside = here_t + leap < limit || has_arrived;
        let relaxed = if is_inside { here_t + leap } else { limit };
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
        let becomes = if is_rare {
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

        let is_far = here.abs() > scouted && free > AWAY * epsilon && p.close[i] == 0;
        let becomes = if is_far && becomes == state::MARCHING && !retreats {
            state::FAR
        } else {
            becomes
        };

        // What becomes of the lane. Where it ends or encloses, it stays where it is.
        let stays = is_rare || is_refuted || is_crossing;
        let begins = is_marching && !is_rare && !is_refuted && is_crossing;
        let sets_last = is_marching && !stays && !goes_back && !retreats && !is_on_surface;
        p.last_t[i] = if sets_last { here_t } else { last_t };
        p.last_value[i] = if sets_last { here } else { last_value };
        p.known[i] = if sets_last { here_t + free } else { p.known[i] };
        p.rough[i] = if sets_last { 0 } else { p.rough[i] };
        // The far end of a step that is doubted, or of a change of sign.
        let is_high = is_marching && (goes_back || begins);
        p.high_t[i] = if is_high { t } else { high_t };
        p.high_value[i] = if is_high { now } else { high_value };
        p.t[i] = if is_marching && !stays { next } else { t };
        p.state[i] = if is_marching { becomes } else { was };
        p.departed[i] |= i64::from(is_marching && free > epsilon);
        p.steps[i] += i64::from(is_stepping);
        let starts_anew =
            is_marching && (begins || becomes == state::MARCHING || becomes == state::FAR);
        let narrowings = if starts_anew { 0 } else { p.narrowings[i] };
        let probes = is_marching && becomes == state::PROBING;
        p.narrowings[i] = narrowings + i64::from(probes);
    }
}

/// Where a change of sign between two samples is looked for next: on the grid, by the secant or else in the middle. The
/// spacing of the grid comes with its reciprocal.
#[inline(always)]
fn inner(
    (grid, finer): (f64, f64),
    (low_t, low): (f64, f64),
    (top_t, top): (f64, f64),
    halves: bool,
) -> f64 {
    let span = top_t - low_t;
    let secant = low_t + low / (low - top) * span;
    let middle = low_t + 0.5 * span;
    let is_within = secant >= low_t && secant <= top_t;
    let inner = if halves || !is_within { middle } else { secant };
    let below = Number::floor(inner * finer) * grid;
    let above = (Number::floor(low_t * finer) + 1.0) * grid;
    let aligned = if below > low_t { below } else { above };
    // Where a sample is zero, the surface is there; what is left to see is that it is not before.
    let beside = if top_t - grid > low_t {
        top_t - grid
    } else {
        middle
    };
    let aligned = if top == 0.0 && !halves {
        beside
    } else {
        aligned
    };
    if aligned < top_t { aligned } else { middle }
}

/// Where lane `i` looks first for a change of sign between two samples.
#[inline(always)]
pub(super) fn first_probe(p: &Packet, i: usize, low: (f64, f64), top: (f64, f64)) -> f64 {
    inner((p.grid[i], p.finer[i]), low, top, false)
}

/// A step of the lanes from `first` on that enclose: the new sample takes the place of the end with its sign.
#[inline(always)]
fn narrow(p: &mut Packet, values: &Lane, rules: &Rules, first: usize) {
    // Where any hit will do, a change of sign needs no more.
    let careless = if rules.any { f64::INFINITY } else { 0.0 };
    for i in first..first + GROUP {
        let encloses = p.state[i] == state::ENCLOSING;
        let (now, t) = (values[i], p.t[i]);
        let is_low = now != 0.0 && (now < 0.0) == (p.last_value[i] < 0.0);
        let low_t = if is_low { t } else { p.last_t[i] };
        let low_value = if is_low { now } else { p.last_value[i] };
        let top_t = if is_low { p.high_t[i] } else { t };
        let top_value = if is_low { p.high_value[i] } else { now };
        let span = top_t - low_t;
        // Both are powers of two, so their products are exact.
        let (grid, finer) = (p.grid[i], p.finer[i]);
        let widest = grid + careless;
        let narrowings = p.narrowings[i];
        let is_done = span <= widest || narrowings >= MAX_NARROWINGS;
        let halves = narrowings & 3 == 3;
        let probe = inner(
            (grid, finer),
            (low_t, low_value),
            (top_t, top_value),
            halves,
        );
        let becomes = if is_done {
            state::HIT
        } else {
            state::ENCLOSING
        };
        p.state[i] = if encloses { becomes } else { p.state[i] };
        p.last_t[i] = if encloses { low_t } else { p.last_t[i] };
        p.last_value[i] = if encloses { low_value } else { p.last_value[i] };
        p.high_t[i] = if encloses { top_t } else { p.high_t[i] };
        p.high_value[i] = if encloses { top_value } else { p.high_value[i] };
        p.t[i] = if encloses { probe } else { t };
        p.narrowings[i] = narrowings + i64::from(encloses);
    }
}
