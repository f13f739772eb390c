//! Scouts: rays go through free space by values in single precision, and certify it all the same.
//!
//! A value in `f32` is known within a bound of its rounding errors, which is taken off before it certifies anything: so what a
//! scout has passed is free, and a change of sign that it has seen is one. Where the bound says too little, close to a surface
//! that is only grazed, the lane goes on in double precision; so does every lane that encloses a change of sign. Steps are
//! those of `stride.rs` without a memory of far ends: a step that went farther than is known to be free is taken again,
//! shorter. Twice as many lanes fit into a register, and roots and quotients take a third of the time. Sources: as
//! `stride.rs`; Higham 2002, chapter 3, for running error bounds.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::bundle::WIDTH;
use super::fan::{PATIENCE, STRAGGLERS};
use super::packet::{Packet, Rules, count, state};
use super::part::Short;
use super::stride::{LARGEST_TREND, SHYNESS, first_probe};
use crate::field::{Closure, Task};
use crate::num::{F32x32, Lanes, Vec3};

/// The lanes of a packet that are far from surfaces walk on until each has come close to one, has seen a change of sign or has
/// come to the end of its stretch.
pub(super) struct Scout<'a> {
    /// The lanes.
    pub packet: &'a mut Packet,
    /// The field.
    pub value: &'a Closure<F32x32>,
    /// What is known of it in single precision.
    pub short: &'a Short,
    /// What it goes by.
    pub rules: &'a Rules,
    /// It ends once no more lanes than this go on.
    pub few: i64,
}

/// A single precision number for each lane.
type Numbers = [f32; WIDTH];

/// What a lane does.
mod pace {
    /// Nothing: its ray does not take part.
    pub const IDLE: i32 = 0;
    /// It steps, and has no sample yet.
    pub const FRESH: i32 = 1;
    /// It steps, and has a last sample.
    pub const STEPPING: i32 = 2;
    /// It goes on in double precision from where its way is known to be free.
    pub const CLOSE: i32 = 3;
    /// It has come to the end of its stretch.
    pub const ARRIVED: i32 = 4;
    /// It has seen a change of sign.
    pub const CROSSED: i32 = 5;
}

/// Numbers are rounded to this share of themselves at most, with room for some roundings.
const ROOM: f32 = 1.0 / (1u32 << 19) as f32;

/// Room for the rounding of what is computed from bends, as a share of them.
const BEND_ROOM: f32 = 1e-4;

/// The shortest step, in tolerances.
const LEAST: f32 = 0.125;

/// A step over a surface goes beyond where the trend says that it is, by this factor.
const BEYOND: f32 = 1.0625;

/// By how much the end of a stretch may be rounded, as a share of it, with room.
const FINE: f32 = 1.0 / (1u32 << 22) as f32;

/// How many lanes go through a step at once.
const GROUP: usize = 16;

/// How many lanes go through a loop at once in double precision.
const WIDE: usize = 8;

/// The lanes of a packet as scouts: distances are from where the rays enter the region.
struct Scouts {
    place: [Numbers; 3],
    direction: [Numbers; 3],
    /// The tolerance at the entry, and by how much it grows with each scene unit.
    tolerance: Numbers,
    spread: Numbers,
    /// Where the stretch ends.
    limit: Numbers,
    /// Where the field is wanted next.
    t: Numbers,
    /// The last sample; where there is none, the side on which the ray is.
    last_t: Numbers,
    last_value: Numbers,
    /// Up to where the way behind the last sample is known to be free.
    known: Numbers,
    /// The value beyond a change of sign.
    beyond: Numbers,
    pace: [i32; WIDTH],
    /// Whether it has taken a sample that says that its way is free.
    passed: [i32; WIDTH],
    steps: [i32; WIDTH],
    evaluations: [i32; WIDTH],
}

/// What steps go by.
struct Gauge {
    /// The constant, with room for rounding.
    slope: f32,
    /// The reciprocal of a larger one, so that steps certify themselves.
    inverse: f32,
    /// How much the slope along a ray falls at most on a unit, outside and inside; infinite where that is not known.
    bends: [f32; 2],
    error: f32,
    max_steps: i32,
    /// Added to what certifies a change of sign: infinite where any hit will do.
    careless: f32,
}

impl Task for Scout<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self {
            packet,
            value,
            short,
            rules,
            few,
        } = self;
        if count(&packet.state, |state| state == state::FAR) <= few {
            return;
        }
        let gauge = Gauge {
            slope: rules.lipschitz as f32 * (1.0 + 4.0 * ROOM),
            inverse: (1.0 - 8.0 * ROOM) / rules.lipschitz as f32,
            bends: short.bends.map(|bend| bend as f32 * (1.0 + BEND_ROOM)),
            error: short.error as f32 * (1.0 + ROOM),
            max_steps: rules.max_steps.min(i32::MAX as u32) as i32,
            careless: if rules.any { f32::INFINITY } else { 0.0 },
        };
        let mut scouts = Scouts::of(packet, rules);
        if gauge.bends[0] < f32::INFINITY {
            scouts.walk::<true>(value, &gauge, few);
        } else {
            scouts.walk::<false>(value, &gauge, few);
        }
        scouts.report(packet, rules);
    }
}

/// How far a value stays above zero that changes with this slope, which falls with this bend.
#[inline(always)]
fn falling(value: f32, slope: f32, bend: f32) -> f32 {
    let root = (slope * slope + 2.0 * bend * value).sqrt();
    let rising = (slope + root) / bend;
    let falling = 2.0 * value / (root - slope);
    let free = if slope > 0.0 { rising } else { falling };
    free * (1.0 - 16.0 * ROOM)
}

impl Scouts {
    /// The lanes of a packet that are far from surfaces.
    #[inline(always)]
    fn of(p: &Packet, rules: &Rules) -> Self {
        let zero = [0.0; WIDTH];
        let mut s = Self {
            place: [zero; 3],
            direction: [zero; 3],
            tolerance: zero,
            spread: zero,
            limit: zero,
            t: zero,
            last_t: zero,
            last_value: zero,
            known: zero,
            beyond: zero,
            pace: [pace::IDLE; WIDTH],
            passed: [0; WIDTH],
            steps: [0; WIDTH],
            evaluations: [0; WIDTH],
        };
        for axis in 0..3 {
            for i in 0..WIDTH {
                let (o, d) = (p.origin[axis][i], p.direction[axis][i]);
                s.place[axis][i] = (o + d * p.start[i]) as f32;
                s.direction[axis][i] = d as f32;
            }
        }
        for i in 0..WIDTH {
            let start = p.start[i];
            let has_last = p.last_t[i] > f64::NEG_INFINITY;
            let t = (p.t[i] - start) as f32;
            s.tolerance[i] = (rules.tolerance * (p.footprint[i] + p.spread[i] * start)) as f32;
            s.spread[i] = (rules.tolerance * p.spread[i]) as f32;
            s.limit[i] = (p.limit[i] - start) as f32;
            s.t[i] = t;
            s.last_t[i] = if has_last {
                (p.last_t[i] - start) as f32
            } else {
                t
            };
            s.last_value[i] = if has_last {
                p.last_value[i] as f32
            } else {
                p.side[i] as f32
            };
            let begins = if has_last {
                pace::STEPPING
            } else {
                pace::FRESH
            };
            s.known[i] = if has_last {
                (p.known[i] - start) as f32
            } else {
                t
            };
            s.pace[i] = if p.state[i] == state::FAR {
                begins
            } else {
                pace::IDLE
            };
            s.steps[i] = p.steps[i] as i32;
        }
        s
    }

    /// Walks until no more than `few` lanes go on. `BENT` says whether the bend is known.
    #[inline(always)]
    fn walk<const BENT: bool>(&mut self, value: &Closure<F32x32>, gauge: &Gauge, few: i64) {
        // Where bends count, steps grow even beside a surface.
        let patience = PATIENCE * if BENT { 8 } else { 1 };
        for round in 1.. {
            let values = value(&self.places());
            let going = i64::from(self.step::<BENT>(&values.0, gauge));
            if going <= few {
                return;
            }
            if going <= STRAGGLERS && round >= patience {
                self.stop();
                return;
            }
        }
    }

    /// Lets the lanes that still step go on in double precision, where lanes that lag behind are walked one by one.
    fn stop(&mut self) {
        for pace in &mut self.pace {
            if *pace == pace::STEPPING {
                *pace = pace::CLOSE;
            }
        }
    }

    /// Where the field is wanted.
    #[inline(always)]
    fn places(&self) -> Vec3<F32x32> {
        let mut places = [[0.0; WIDTH]; 3];
        for axis in 0..3 {
            for i in 0..WIDTH {
                places[axis][i] = self.place[axis][i] + self.direction[axis][i] * self.t[i];
            }
        }
        let [x, y, z] = places.map(Lanes);
        Vec3::new(x, y, z)
    }

    /// Lets every lane observe its value; gives how many go on.
    #[inline(always)]
    fn step<const BENT: bool>(&mut self, values: &Numbers, gauge: &Gauge) -> i32 {
        let mut going = [0; GROUP];
        for first in (0..WIDTH).step_by(GROUP) {
            for k in 0..GROUP {
                going[k] += self.observe::<BENT>(values, gauge, first + k);
            }
        }
        going.into_iter().sum()
    }

    /// Lets one lane observe its value; gives 1 if it goes on. Free of branches, for loops over lanes.
    #[inline(always)]
    fn observe<const BENT: bool>(&mut self, values: &Numbers, gauge: &Gauge, i: usize) -> i32 {
        let s = self;
        let (now, t, was) = (values[i], s.t[i], s.pace[i]);
        let (last_t, last) = (s.last_t[i], s.last_value[i]);
        let is_fresh = was == pace::FRESH;
        let has_last = was == pace::STEPPING;
        let is_going = is_fresh | has_last;
        let tolerance = s.tolerance[i] + s.spread[i] * t;
        let [outside, inside] = gauge.bends;
        let bend = if last < 0.0 { inside } else { outside };

        // The values less their errors, seen from the side of the last sample.
        let differs = (now < 0.0) != (last < 0.0);
        let is_certain = now.abs() > gauge.error;
        let here = if differs { -now.abs() } else { now.abs() } - gauge.error;
        let before = last.abs() - gauge.error;
        let width = t - last_t;
        // How far the way behind the last sample is known to be free, if not all of it is.
        let short = s.known[i] - last_t;
        let is_covered = short + here * gauge.inverse >= width;
        let is_free = is_fresh | (before + here >= gauge.slope * width) | is_covered;
        let is_narrow = width - short <= tolerance + gauge.careless;
        let sum = before + now.abs() - gauge.error;
        let is_enough = is_narrow | (sum + gauge.slope * tolerance >= gauge.slope * width);
        let is_spent = s.steps[i] + 1 >= gauge.max_steps;
        let is_fine = is_certain & !is_spent;
        let crosses = has_last & is_certain & differs & is_enough;
        let passes = is_fine & !differs & is_free;
        // Otherwise the step is taken again, shorter.
        let least = tolerance * LEAST;
        let retreats = has_last & is_fine & !crosses & !passes & (short >= least);

        // On from here: at what is left of the trend, the value falls no faster than by `drop` and the bend.
        let rise = now.abs() - last.abs();
        let by_slope = here * gauge.inverse;
        let free = if BENT {
            let drop = (rise - 2.0 * gauge.error) / width - 0.5 * bend * width;
            let by_bend = falling(here, drop, bend);
            let is_bent = has_last & (by_bend > by_slope);
            if is_bent { by_bend } else { by_slope }
        } else {
            by_slope
        };
        // No sample lies beyond the end of the stretch, whichever way it was rounded.
        let (limit, beyond) = (s.limit[i] * (1.0 - FINE), s.limit[i] * (1.0 + FINE));
        let has_arrived = t + free >= beyond;
        let is_at_end = t >= limit;
        let way = gauge.slope * width;
        let lowest = (1.0 - LARGEST_TREND as f32) * way;
        let left = if way - rise > lowest {
            way - rise
        } else {
            lowest
        };
        let factor = SHYNESS as f32 * way / left;
        let may_leap = has_last & (factor > 1.0);
        let leap = by_slope * if may_leap { factor } else { 1.0 };
        let leap = if leap > free { leap } else { free };
        let leap = if leap >= least { leap } else { least };
        // Over the surface, where the trend says that both sides will certify it.
        let over = now.abs() * width / -rise * BEYOND;
        let will_do = now.abs() * BEYOND + gauge.slope * tolerance - 4.0 * gauge.error;
        let will_be_narrow = over - free <= 0.75 * tolerance + gauge.careless;
        let is_over = has_last & (rise < 0.0) & ((will_do >= gauge.slope * over) | will_be_narrow);
        let leap = if is_over & (over > free) { over } else { leap };
        let next = if t + leap < limit { t + leap } else { limit };
        let next = if has_arrived { t + free } else { next };
        let becomes = if is_at_end {
            pace::CLOSE
        } else {
            pace::STEPPING
        };
        let becomes = if has_arrived { pace::ARRIVED } else { becomes };
        let becomes = if passes { becomes } else { pace::CLOSE };
        let becomes = if retreats { pace::STEPPING } else { becomes };
        let becomes = if crosses { pace::CROSSED } else { becomes };

        let moved = if passes { next } else { t };
        let moved = if retreats { last_t + short } else { moved };
        let sets_last = is_going & passes;
        s.t[i] = if is_going { moved } else { t };
        s.last_t[i] = if sets_last { t } else { last_t };
        s.last_value[i] = if sets_last { now } else { last };
        s.known[i] = if sets_last { t + free } else { s.known[i] };
        s.passed[i] |= i32::from(sets_last);
        s.beyond[i] = if is_going & crosses { now } else { s.beyond[i] };
        s.pace[i] = if is_going { becomes } else { was };
        s.steps[i] += i32::from(is_going);
        s.evaluations[i] += i32::from(is_going);
        i32::from(is_going & (becomes == pace::STEPPING))
    }

    /// Writes back to the packet what the lanes have found.
    #[inline(always)]
    fn report(&self, p: &mut Packet, rules: &Rules) {
        let found = if rules.any {
            state::HIT
        } else {
            state::ENCLOSING
        };
        for first in (0..WIDTH).step_by(WIDE) {
            self.report_some(p, found, first);
        }
    }

    /// As [`Scouts::report`], for the lanes from `first` on; `found` is the state of those that have seen a change of sign.
    #[inline(always)]
    fn report_some(&self, p: &mut Packet, found: i64, first: usize) {
        let s = self;
        // Each question by itself, in double precision: the compiler knows that a lane does one thing only, and of what follows
        // from that it makes branches.
        let (mut takes_part, mut is_on, mut arrives) = ([0.0; WIDE], [0.0; WIDE], [0.0; WIDE]);
        let (mut is_close, mut crosses, mut passed) = ([0.0; WIDE], [0.0; WIDE], [0.0; WIDE]);
        let mut wide = [[0.0; WIDE]; 5];
        for k in 0..WIDE {
            let i = first + k;
            let pace = s.pace[i];
            let steps = (pace == pace::FRESH) | (pace == pace::STEPPING);
            takes_part[k] = f64::from(i32::from(pace != pace::IDLE));
            is_on[k] = f64::from(i32::from(steps));
            arrives[k] = f64::from(i32::from(pace == pace::ARRIVED));
            is_close[k] = f64::from(i32::from(pace == pace::CLOSE));
            crosses[k] = f64::from(i32::from(pace == pace::CROSSED));
            passed[k] = f64::from(s.passed[i]);
            wide[0][k] = f64::from(s.t[i]);
            wide[1][k] = f64::from(s.last_t[i]);
            wide[2][k] = f64::from(s.last_value[i]);
            wide[3][k] = f64::from(s.beyond[i]);
            wide[4][k] = f64::from(s.known[i]);
        }
        let [ways, last_ways, lows, highs, knowns] = &wide;
        for k in 0..WIDE {
            let i = first + k;
            let (takes_part, is_on) = (takes_part[k] != 0.0, is_on[k] != 0.0);
            let (start, limit) = (p.start[i], p.limit[i]);
            // Read before anything is chosen: else lanes choose what to read.
            let (before_t, before) = (p.last_t[i], p.last_value[i]);
            let (was_t, was_known, was_side) = (p.t[i], p.known[i], p.side[i]);
            let (was_high_t, was_high) = (p.high_t[i], p.high_value[i]);
            let (was, narrowings) = (p.state[i], p.narrowings[i]);
            let had_last = before_t > f64::NEG_INFINITY;
            // Nothing that was rounded takes the place of what was known before.
            let has_passed = passed[k] != 0.0;
            let is_kept = takes_part & !has_passed;
            let t = start + ways[k];
            let last_t = start + last_ways[k];
            let low_t = if is_kept { before_t } else { last_t };
            let (low, high) = (lows[k], highs[k]);
            let has_crossed = (crosses[k] != 0.0) & (t <= limit);
            let is_close = (is_close[k] != 0.0) | ((crosses[k] != 0.0) & (t > limit));
            let probe = first_probe(p, i, (low_t, low), (t, high));
            // A lane that is close starts anew from where its way is known to be free.
            let is_rough = p.rough[i] != 0;
            let marches_on = is_kept & had_last & !is_rough;
            let anew = if marches_on {
                state::MARCHING
            } else {
                state::FRESH
            };
            let becomes = if has_crossed { found } else { anew };
            let becomes = if arrives[k] != 0.0 {
                state::ARRIVED
            } else {
                becomes
            };
            let becomes = if is_on { state::FAR } else { becomes };
            let known = if knowns[k] < ways[k] {
                knowns[k]
            } else {
                ways[k]
            };
            let stays = is_kept & had_last & (is_rough | is_on);
            let from = if stays { was_known } else { was_t };
            let from = if is_kept { from } else { start + known };
            let next = if has_crossed { probe } else { t };
            let goes_back = is_close | (is_on & is_kept);
            let next = if goes_back { from } else { next };
            let is_lost = is_close & (has_passed | is_rough);
            let behind = if is_lost { f64::NEG_INFINITY } else { low_t };
            let side = if low < 0.0 { -1.0 } else { 1.0 };
            let free = start + knowns[k];
            p.t[i] = if takes_part { next } else { was_t };
            p.last_t[i] = if takes_part { behind } else { before_t };
            p.last_value[i] = if has_passed { low } else { before };
            p.known[i] = if has_passed { free } else { was_known };
            p.side[i] = if has_passed { side } else { was_side };
            p.high_t[i] = if has_crossed { t } else { was_high_t };
            p.high_value[i] = if has_crossed { high } else { was_high };
            p.narrowings[i] = if takes_part { 0 } else { narrowings };
            p.state[i] = if takes_part { becomes } else { was };
        }
        for k in 0..WIDE {
            let i = first + k;
            p.rough[i] |= i64::from(s.passed[i]);
            p.close[i] |= i64::from(s.pace[i] == pace::CLOSE);
            p.evaluations[i] += i64::from(s.evaluations[i]);
            // Those of lanes that don't take part are what they were.
            p.steps[i] = i64::from(s.steps[i]);
        }
    }
}
