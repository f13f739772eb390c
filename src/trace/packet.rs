//! Packets: 32 rays on their way through one field, in lanes.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::Verdict;
use super::bits::{LANES, bits, ones};
use super::bundle::{Bundle, Choice, WIDTH};
use super::hierarchy::stretch;
use super::method::{Ending, finest};
use super::part::Marched;
use crate::field::{Level, Task, run_at};
use crate::num::{F64x32, Lanes, Number, Vec3};

/// A number for each lane.
pub(super) type Lane = [f64; WIDTH];

/// What a lane does. As 64-bit numbers, so that they are as wide as the lanes.
pub(super) mod state {
    /// Nothing: there is no ray in it.
    pub const IDLE: i64 = 0;
    /// It steps, and has no sample yet that it could compare with.
    pub const FRESH: i64 = 1;
    /// It steps, and has a last sample.
    pub const MARCHING: i64 = 2;
    /// It looks for a pair of roots inside of a step that went farther than is known to be free.
    pub const PROBING: i64 = 3;
    /// It narrows a change of sign.
    pub const ENCLOSING: i64 = 4;
    /// It has come to the end of its stretch.
    pub const ARRIVED: i64 = 5;
    /// It has found a surface.
    pub const HIT: i64 = 6;
    /// The field is steeper than its constant.
    pub const REFUTED: i64 = 7;
    /// It goes on by itself, outside of the lanes.
    pub const SINGLE: i64 = 8;
    /// It steps through free space in single precision.
    pub const FAR: i64 = 9;
    /// It has crept along close to a surface for long: ranges are asked how closely it should look.
    pub const STUCK: i64 = 10;

    /// Whether it steps or looks for a pair of roots.
    #[inline(always)]
    pub fn is_marching(state: i64) -> bool {
        state > IDLE && state < ENCLOSING
    }

    /// Whether it has something before it, now or in another stretch.
    #[inline(always)]
    pub fn is_walking(state: i64) -> bool {
        state == FRESH || state == MARCHING || state == ARRIVED
    }

    /// Whether what it found, or did not find, is to be looked at.
    #[inline(always)]
    pub fn has_ended(state: i64) -> bool {
        (state > ARRIVED) & (state != FAR)
    }

    /// Whether it wants another value.
    #[inline(always)]
    pub fn is_going(state: i64) -> bool {
        state > IDLE && state < ARRIVED
    }
}

/// How closely a lane looks where it creeps along a surface, as 64-bit numbers.
pub(super) mod patience {
    /// As closely as rounding allows, and soon it is stuck.
    pub const SHORT: i64 = 0;
    /// So, for long: ranges say something.
    pub const LONG: i64 = 1;
    /// Not into gaps far below the tolerance: ranges say nothing.
    pub const COARSE: i64 = 2;
}

/// How many lanes are looked at side by side.
const GROUP: usize = 8;

/// How a tolerance is divided by the grid on which hits lie: one more evaluation than a thousandth takes, and what is
/// computed from hits is as good as exact.
const GRID: f64 = 1.0 / (1u64 << 22) as f64;

/// The smallest distance at which a footprint counts for the grid, in sizes of the scene.
const NEAR: f64 = 1.0 / 1024.0;

/// 32 rays on their way through one field; by default none. Every column begins with a cache line.
#[derive(Default)]
#[repr(C, align(64))]
pub(super) struct Packet {
    pub(super) origin: [Lane; 3],
    pub(super) direction: [Lane; 3],
    pub(super) footprint: Lane,
    pub(super) spread: Lane,
    /// The size of coordinates on the way, for rounding errors.
    pub(super) size: Lane,
    /// Beyond this, a ray through a shape without end is given up.
    pub(super) far: Lane,
    /// The spacing of the places where hits are enclosed: a power of two.
    pub(super) grid: Lane,
    /// Its reciprocal.
    pub(super) finer: Lane,
    /// Where the ray enters the region.
    pub(super) start: Lane,
    /// Where it leaves it.
    pub(super) end: Lane,
    /// Where the stretch ends that is walked now.
    pub(super) limit: Lane,
    /// Where the field is wanted next.
    pub(super) t: Lane,
    /// The error of a hit that a walk by tangents found.
    pub(super) error: Lane,
    /// On which side of the surface the ray is known to be as long as it has no last sample: 1 outside, -1 inside, 0 unknown.
    pub(super) side: Lane,
    /// Where the last sample that counts was taken; before all where there is none.
    pub(super) last_t: Lane,
    pub(super) last_value: Lane,
    /// Up to where the way is known to be free, where there is a last sample.
    pub(super) known: Lane,
    pub(super) high_t: Lane,
    pub(super) high_value: Lane,
    pub(super) state: [i64; WIDTH],
    pub(super) departed: [i64; WIDTH],
    /// Whether the last sample was taken in single precision.
    pub(super) rough: [i64; WIDTH],
    /// Whether single precision says too little where the lane is.
    pub(super) close: [i64; WIDTH],
    /// How closely it looks where it creeps along a surface.
    pub(super) patience: [i64; WIDTH],
    pub(super) steps: [i64; WIDTH],
    pub(super) narrowings: [i64; WIDTH],
    pub(super) evaluations: [i64; WIDTH],
    /// Which ray of the bundle each lane has.
    pub ray: [u32; WIDTH],
    /// How many lanes have a ray.
    pub count: usize,
}

/// What a packet needs to know of the field and the settings.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rules {
    /// The Lipschitz constant.
    pub lipschitz: f64,
    /// The tolerance, in footprints.
    pub tolerance: f64,
    /// How many steps a ray may take.
    pub max_steps: u32,
    /// How far the region reaches from the origin.
    pub reach: f64,
    /// The size of the region; infinite where it has no end.
    pub extent: f64,
    /// Whether the shape has no finite bounds.
    pub is_endless: bool,
    /// Whether any hit will do, wherever it is.
    pub any: bool,
}

/// What a lane found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    /// Which lane.
    pub lane: usize,
    /// How it ended.
    pub ending: Ending,
}

/// Copies a lane of one packet to a lane of another, or of the same.
macro_rules! copy_lane {
    ($from:expr, $source:expr => $to:expr, $lane:expr) => {{
        for axis in 0..3 {
            $to.origin[axis][$lane] = $from.origin[axis][$source];
            $to.direction[axis][$lane] = $from.direction[axis][$source];
        }
        copy_lane! {
            $from, $source => $to, $lane;
            footprint spread size far grid finer start end limit t error side last_t last_value known high_t high_value state departed
            rough close patience steps narrowings evaluations ray
        }
    }};
    ($from:expr, $source:expr => $to:expr, $lane:expr; $($column:ident)*) => {
        $($to.$column[$lane] = $from.$column[$source];)*
    };
}

/// Takes these rays of a bundle, at most 32, from where they enter the region to where they leave it.
pub(super) struct Load<'a> {
    /// The lanes.
    pub packet: &'a mut Packet,
    /// Where the rays are.
    pub bundle: &'a Bundle,
    /// Which of them.
    pub rays: &'a [u32],
    /// What they go by.
    pub rules: &'a Rules,
}

impl Task for Load<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self {
            packet: p,
            bundle,
            rays,
            rules,
        } = self;
        p.count = rays.len();
        let choice = Choice::of(rays);
        p.ray = choice.rays();
        for lane in 0..WIDTH {
            p.state[lane] = if lane < rays.len() {
                state::FRESH
            } else {
                state::IDLE
            };
        }
        for axis in 0..3 {
            p.origin[axis] = choice.picked(&bundle.origin[axis]);
            p.direction[axis] = choice.picked(&bundle.direction[axis]);
        }
        p.footprint = choice.picked(&bundle.footprint);
        p.spread = choice.picked(&bundle.spread);
        let enter = choice.picked(&bundle.enter);
        let leave = choice.picked(&bundle.leave);
        let t_max = choice.picked(&bundle.t_max);
        for lane in 0..WIDTH {
            let [x, y, z] = [&p.origin[0], &p.origin[1], &p.origin[2]];
            let origin = larger(larger(x[lane].abs(), y[lane].abs()), z[lane].abs());
            let (start, end) = stretch(origin, enter[lane], leave[lane], t_max[lane]);
            let size = origin + rules.reach;
            let spacing = grid(start, size, rules, p.footprint[lane], p.spread[lane]);
            p.size[lane] = size;
            p.grid[lane] = spacing;
            p.finer[lane] = 1.0 / spacing;
            p.start[lane] = start;
            p.end[lane] = end;
            p.limit[lane] = end;
            p.t[lane] = start;
            // The region holds the solid, so a ray that comes into it is outside, whatever rounding says.
            p.side[lane] = if start > 0.0 { 1.0 } else { 0.0 };
            p.departed[lane] = i64::from(start > 0.0);
        }
        p.rough = [0; WIDTH];
        p.close = [0; WIDTH];
        p.patience = [patience::SHORT; WIDTH];
        p.far = [f64::INFINITY; WIDTH];
        p.error = [0.0; WIDTH];
        p.last_t = [f64::NEG_INFINITY; WIDTH];
        p.last_value = [0.0; WIDTH];
        p.known = [0.0; WIDTH];
        p.high_t = [0.0; WIDTH];
        p.high_value = [0.0; WIDTH];
        p.steps = [0; WIDTH];
        p.narrowings = [0; WIDTH];
        p.evaluations = [0; WIDTH];
    }
}

/// Readies the lanes for the stretch from `from` up to `to`; gives whether any lane has a way to go.
pub(super) struct Proceed<'a> {
    /// The lanes.
    pub packet: &'a mut Packet,
    /// Where the stretch begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// The side (1 outside, -1 inside) on which what lies before it is known to be, and free, if that is known.
    pub before: Option<f64>,
}

impl Task for Proceed<'_> {
    type Output = bool;

    #[inline(always)]
    fn run(self) -> bool {
        let p = self.packet;
        let side = self.before.unwrap_or(0.0);
        // The samples before a free stretch say nothing any more.
        let from = if self.before.is_some() {
            self.from
        } else {
            f64::NEG_INFINITY
        };
        let mut any = false;
        for lane in 0..WIDTH {
            let was = p.state[lane];
            let walks = state::is_walking(was);
            let skips = walks && p.t[lane] < from;
            let t = if skips { from } else { p.t[lane] };
            let last_t = if skips {
                f64::NEG_INFINITY
            } else {
                p.last_t[lane]
            };
            let limit = smaller(self.to, p.end[lane]);
            let on = if last_t > f64::NEG_INFINITY {
                state::MARCHING
            } else {
                state::FRESH
            };
            let becomes = if t > limit { state::ARRIVED } else { on };
            p.t[lane] = t;
            p.last_t[lane] = last_t;
            p.side[lane] = if skips { side } else { p.side[lane] };
            p.departed[lane] |= i64::from(skips);
            p.close[lane] = if walks { 0 } else { p.close[lane] };
            p.limit[lane] = if walks { limit } else { p.limit[lane] };
            p.state[lane] = if walks { becomes } else { was };
            any |= walks && becomes != state::ARRIVED;
        }
        any
    }
}

/// Tells the lanes that step far from surfaces from the others; gives whether any of these goes on.
pub(super) struct Muster<'a> {
    /// The lanes.
    pub packet: &'a mut Packet,
    /// A last value has to be larger than that.
    pub least: f64,
    /// How far the region reaches from the origin of coordinates.
    pub reach: f64,
}

/// A ray that starts so many sizes of its region away is not told well enough where it comes in.
const REMOTE: f64 = (1u64 << 24) as f64;

impl Task for Muster<'_> {
    type Output = bool;

    #[inline(always)]
    fn run(self) -> bool {
        let p = self.packet;
        let remote = REMOTE * self.reach;
        let mut goes = false;
        for i in 0..WIDTH {
            let was = p.state[i];
            let is_told = (was == state::MARCHING) & (p.last_value[i].abs() > self.least);
            let steps = (was == state::FRESH) | is_told;
            let is_open = (p.departed[i] != 0) & (p.close[i] == 0);
            let is_far = steps & is_open & (p.size[i] <= remote);
            // Samples in single precision refute nothing, so the other machine begins anew.
            let begins = (was == state::MARCHING) & (p.rough[i] != 0) & !is_far;
            let stays = if begins { state::FRESH } else { was };
            p.state[i] = if is_far { state::FAR } else { stays };
            p.t[i] = if begins { p.known[i] } else { p.t[i] };
            p.last_t[i] = if begins {
                f64::NEG_INFINITY
            } else {
                p.last_t[i]
            };
            goes |= state::is_going(p.state[i]);
        }
        goes
    }
}

/// How many lanes are in such a state.
#[inline(always)]
pub(super) fn count(states: &[i64; WIDTH], is_such: impl Fn(i64) -> bool) -> i64 {
    // Not one sum: it would be taken lane by lane.
    let mut counts = [0; GROUP];
    for first in (0..WIDTH).step_by(GROUP) {
        for k in 0..GROUP {
            counts[k] += i64::from(is_such(states[first + k]));
        }
    }
    counts.into_iter().sum()
}

#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

impl Packet {
    /// Whether a lane has a last sample.
    #[inline(always)]
    pub fn has_last(&self, lane: usize) -> bool {
        self.last_t[lane] > f64::NEG_INFINITY
    }

    /// Takes over a lane of another packet, which is idle afterwards.
    pub fn adopt(&mut self, lane: usize, other: &mut Self, from: usize) {
        copy_lane!(other, from => self, lane);
        other.leave(from);
    }

    /// Moves a lane to another place.
    pub fn shift(&mut self, lane: usize, from: usize) {
        copy_lane!(self, from => self, lane);
        self.leave(from);
    }

    fn leave(&mut self, lane: usize) {
        self.state[lane] = state::IDLE;
        (self.steps[lane], self.evaluations[lane]) = (0, 0);
    }

    /// Leaves all lanes idle.
    pub fn clear(&mut self) {
        self.state = [state::IDLE; WIDTH];
    }

    /// The lanes that go on, in whichever precision.
    pub fn going(&self, level: Level) -> impl Iterator<Item = usize> + use<> {
        self.lanes(level, |state| {
            state::is_going(state) | (state == state::FAR)
        })
    }

    /// The lanes that have come to the end of their stretch.
    pub fn arrived(&self, level: Level) -> impl Iterator<Item = usize> + use<> {
        self.lanes(level, |state| state == state::ARRIVED)
    }

    /// The lanes that are in such a state now.
    fn lanes<F: Fn(i64) -> bool>(
        &self,
        level: Level,
        is_such: F,
    ) -> impl Iterator<Item = usize> + use<F> {
        let states = &self.state;
        ones(run_at(level, Such { states, is_such }))
    }

    /// Lets every lane walk by itself.
    pub fn walk_singly(&mut self) {
        for lane in 0..self.count {
            self.state[lane] = state::SINGLE;
            self.steps[lane] = 1;
            self.evaluations[lane] = 1;
        }
    }

    /// The places of all lanes at these distances.
    pub fn places(&self, t: &Lane) -> Vec3<F64x32> {
        places(&self.origin, &self.direction, t)
    }

    /// Which lanes have found something since the last time, with the rare ones walked to their ends one by one. Those that
    /// are stuck go on.
    pub fn found(&mut self, rules: &Rules, marched: &Marched, sink: &mut Vec<Found>) {
        let level = marched.level();
        run_at(level, Place(self));
        for lane in self.lanes(level, state::has_ended) {
            let ending = match self.state[lane] {
                state::HIT => Ending {
                    verdict: Verdict::Hit,
                    t: self.t[lane],
                    error: self.error[lane],
                    steps: self.steps[lane] as u32,
                },
                state::REFUTED => self.refuted(lane, marched),
                state::SINGLE => self.single(lane, rules, marched),
                state::STUCK => {
                    self.unstick(lane, rules, marched);
                    continue;
                }
                _ => continue,
            };
            self.state[lane] = state::IDLE;
            sink.push(Found { lane, ending });
        }
    }
}

/// Tells which lanes are in such a state, by their bits.
struct Such<'a, F> {
    states: &'a [i64; WIDTH],
    is_such: F,
}

impl<F: Fn(i64) -> bool> Task for Such<'_, F> {
    type Output = u32;

    #[inline(always)]
    fn run(self) -> u32 {
        let mut set = 0;
        for first in (0..WIDTH).step_by(LANES) {
            set |= bits(|lane| (self.is_such)(self.states[first + lane])) << first;
        }
        set
    }
}

/// Writes where the lanes that have found a surface hit it, and by how much that may be off.
struct Place<'a>(&'a mut Packet);

impl Task for Place<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let p = self.0;
        for lane in 0..WIDTH {
            let (low, high) = (p.last_t[lane], p.high_t[lane]);
            let (a, b) = (p.last_value[lane], p.high_value[lane]);
            let (t, error, size) = (p.t[lane], p.error[lane], p.size[lane]);
            let width = high - low;
            // Both are powers of two, so their products are exact.
            let cells = low * p.finer[lane];
            let is_on_grid = (Number::floor(cells) == cells) & (width == p.grid[lane]);
            let in_cell = place_in_cell((low, a), (high, b));
            let middle = low + 0.5 * width;
            let between = if is_on_grid | (b == 0.0) {
                in_cell
            } else {
                middle
            };
            let least = finest(size, between);
            let off = if width > least { width } else { least };
            // Those that a walk by tangents found are there.
            let is_open = (p.state[lane] == state::HIT) & (error == 0.0);
            p.t[lane] = if is_open { between } else { t };
            p.error[lane] = if is_open { off } else { error };
        }
    }
}

/// Where in a cell of the grid the surface is, between two samples.
#[inline(always)]
pub(super) fn place_in_cell((low, a): (f64, f64), (high, b): (f64, f64)) -> f64 {
    let between = low + a / (a - b) * (high - low);
    if b == 0.0 { high } else { between }
}

/// The spacing of the places where a ray's hits are enclosed: a power of two that depends on the ray and the part alone.
#[inline(always)]
fn grid(start: f64, size: f64, rules: &Rules, footprint: f64, spread: f64) -> f64 {
    let t = larger(start, size * NEAR);
    // Where a pixel is wider than the whole shape, the shape is the measure.
    let tolerance = smaller(rules.tolerance * (footprint + spread * t), rules.extent);
    power_of_two(larger(GRID * tolerance, 2.0 * finest(size, 2.0 * size)))
}

/// The largest power of two that is not above `x`.
#[inline(always)]
fn power_of_two(x: f64) -> f64 {
    let exponent = x.to_bits() & (0x7ff << 52);
    larger(f64::from_bits(exponent), f64::MIN_POSITIVE)
}

#[inline(always)]
pub(super) fn places(origin: &[Lane; 3], direction: &[Lane; 3], t: &Lane) -> Vec3<F64x32> {
    let mut p = [[0.0; WIDTH]; 3];
    for axis in 0..3 {
        for lane in 0..WIDTH {
            p[axis][lane] = origin[axis][lane] + direction[axis][lane] * t[lane];
        }
    }
    let [x, y, z] = p;
    Vec3::new(Lanes(x), Lanes(y), Lanes(z))
}
