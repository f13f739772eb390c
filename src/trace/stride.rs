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

use super::bundle::{Bundle, WIDTH};
use super::method::{Certified, Convex, Ending, Segment, Walk};
use super::part::{Marched, Slope};
use super::survey::decided;
use super::{Footprint, Ray, Verdict};
use crate::field::{Closure, Task};
use crate::num::{Dual, F64x32, Lanes, Number, Vec3};
use glam::DVec3;

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
}

/// How a tolerance is divided by the grid on which hits lie: one more evaluation than a thousandth takes, and what is
/// computed from hits is as good as exact.
const GRID: f64 = 1.0 / (1u64 << 22) as f64;

/// The smallest distance at which a footprint counts for the grid, in sizes of the scene.
const NEAR: f64 = 1.0 / 1024.0;

/// A step is lengthened to this share of what the trend of the field allows, times two: the published factor is 2. Source:
/// Ban and Valasek 2023.
const SHYNESS: f64 = 1.9;

/// The field of a ray that leaves a surface rises at most by this share of its constant, as far as steps count on it.
const LARGEST_TREND: f64 = 0.875;

/// More narrowings than halving needs from any width to rounding; and how many samples may be taken inside of one step.
const MAX_NARROWINGS: i64 = 200;

/// 32 rays on their way through one field.
pub(super) struct Packet {
    pub(super) origin: [Lane; 3],
    pub(super) direction: [Lane; 3],
    pub(super) footprint: Lane,
    pub(super) spread: Lane,
    /// The size of coordinates on the way, for rounding errors.
    pub(super) size: Lane,
    /// Beyond this, a ray through a shape without end is given up.
    far: Lane,
    /// The spacing of the places where hits are enclosed: a power of two.
    grid: Lane,
    /// Its reciprocal.
    finer: Lane,
    /// Where the ray enters the region.
    start: Lane,
    /// Where it leaves it.
    pub(super) end: Lane,
    /// Where the stretch ends that is walked now.
    limit: Lane,
    /// Where the field is wanted next.
    pub(super) t: Lane,
    /// The error of a hit that a walk by tangents found.
    pub(super) error: Lane,
    /// On which side of the surface the ray is known to be: 1 outside, -1 inside, 0 unknown.
    side: Lane,
    last_t: Lane,
    last_value: Lane,
    high_t: Lane,
    high_value: Lane,
    pub(super) state: [i64; WIDTH],
    departed: [i64; WIDTH],
    /// Whether the last sample counts.
    has_last: [i64; WIDTH],
    pub(super) steps: [i64; WIDTH],
    narrowings: [i64; WIDTH],
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
}

/// What a lane found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    /// Which lane.
    pub lane: usize,
    /// How it ended.
    pub ending: Ending,
}

/// All columns of a packet but those with three axes.
macro_rules! columns {
    ($do:ident) => {
        $do! {
            footprint spread size far grid finer start end limit t error side last_t last_value high_t high_value state departed
            has_last steps narrowings evaluations ray
        }
    };
}

impl Packet {
    /// A packet without rays.
    pub fn new() -> Box<Self> {
        let lane = [0.0; WIDTH];
        Box::new(Self {
            origin: [lane; 3],
            direction: [lane; 3],
            footprint: lane,
            spread: lane,
            size: lane,
            far: lane,
            grid: lane,
            finer: lane,
            start: lane,
            end: lane,
            limit: lane,
            t: lane,
            error: lane,
            side: lane,
            last_t: lane,
            last_value: lane,
            high_t: lane,
            high_value: lane,
            state: [state::IDLE; WIDTH],
            departed: [0; WIDTH],
            has_last: [0; WIDTH],
            steps: [0; WIDTH],
            narrowings: [0; WIDTH],
            evaluations: [0; WIDTH],
            ray: [0; WIDTH],
            count: 0,
        })
    }

    /// Takes these rays of a bundle, at most 32, from where they enter the region to where they leave it.
    pub fn load(&mut self, bundle: &Bundle, rays: &[u32], rules: &Rules) {
        self.count = rays.len();
        for lane in 0..WIDTH {
            // Lanes without a ray repeat the first, so that they cost nothing unusual.
            let ray = rays[if lane < rays.len() { lane } else { 0 }] as usize;
            let mut origin = 0.0f64;
            for axis in 0..3 {
                let o = bundle.origin[axis][ray];
                self.origin[axis][lane] = o;
                self.direction[axis][lane] = bundle.direction[axis][ray];
                origin = origin.max(o.abs());
            }
            let (start, end) = stretch(bundle, ray, origin);
            let (footprint, spread) = (bundle.footprint[ray], bundle.spread[ray]);
            let size = origin + rules.reach;
            let has_ray = lane < rays.len();
            self.footprint[lane] = footprint;
            self.spread[lane] = spread;
            self.size[lane] = size;
            self.far[lane] = f64::INFINITY;
            let spacing = grid(start, size, rules, footprint, spread);
            self.grid[lane] = spacing;
            self.finer[lane] = 1.0 / spacing;
            self.start[lane] = start;
            self.end[lane] = end;
            self.error[lane] = 0.0;
            self.limit[lane] = end;
            self.t[lane] = start;
            // The region holds the solid, so a ray that comes into it is outside, whatever rounding says.
            self.side[lane] = if start > 0.0 { 1.0 } else { 0.0 };
            self.last_t[lane] = 0.0;
            self.last_value[lane] = 0.0;
            self.high_t[lane] = 0.0;
            self.high_value[lane] = 0.0;
            self.state[lane] = if has_ray { state::FRESH } else { state::IDLE };
            self.departed[lane] = i64::from(start > 0.0);
            self.has_last[lane] = 0;
            self.steps[lane] = 0;
            self.narrowings[lane] = 0;
            self.evaluations[lane] = 0;
            self.ray[lane] = ray as u32;
        }
    }

    /// Readies the lanes for the stretch from `from` up to `to`. What lies before it is known to be free and on the side
    /// `before` (1 outside, -1 inside), if that is given. Gives whether any lane has a way to go.
    pub fn enter(&mut self, from: f64, to: f64, before: Option<f64>) -> bool {
        let mut any = false;
        for lane in 0..WIDTH {
            if !is_walking(self.state[lane]) {
                continue;
            }
            if let Some(side) = before.filter(|_| self.t[lane] < from) {
                // The samples before the free stretch say nothing any more.
                self.t[lane] = from;
                self.side[lane] = side;
                self.has_last[lane] = 0;
                self.departed[lane] = 1;
            }
            let limit = to.min(self.end[lane]);
            self.limit[lane] = limit;
            self.state[lane] = if self.t[lane] > limit {
                state::ARRIVED
            } else if self.has_last[lane] != 0 {
                state::MARCHING
            } else {
                state::FRESH
            };
            any |= self.state[lane] != state::ARRIVED;
        }
        any
    }

    /// Takes over a lane of another packet, which is idle afterwards.
    pub fn adopt(&mut self, lane: usize, other: &mut Self, from: usize) {
        macro_rules! copy {
            ($($column:ident)*) => { $(self.$column[lane] = other.$column[from];)* };
        }
        for axis in 0..3 {
            self.origin[axis][lane] = other.origin[axis][from];
            self.direction[axis][lane] = other.direction[axis][from];
        }
        columns!(copy);
        other.leave(from);
    }

    /// Moves a lane to another place.
    pub fn shift(&mut self, lane: usize, from: usize) {
        macro_rules! copy {
            ($($column:ident)*) => { $(self.$column[lane] = self.$column[from];)* };
        }
        for axis in 0..3 {
            self.origin[axis][lane] = self.origin[axis][from];
            self.direction[axis][lane] = self.direction[axis][from];
        }
        columns!(copy);
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

    /// The lanes that go on.
    pub fn going(&self) -> impl Iterator<Item = usize> {
        (0..WIDTH)
            .filter(|lane| self.state[*lane] < state::ARRIVED && self.state[*lane] != state::IDLE)
    }

    /// The lanes that have come to the end of their stretch.
    pub fn arrived(&self) -> impl Iterator<Item = usize> {
        (0..WIDTH).filter(|lane| self.state[*lane] == state::ARRIVED)
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

    /// Which lanes have found something since the last time, with the rare ones walked to their ends one by one.
    pub fn found(&mut self, rules: &Rules, marched: &Marched, sink: &mut Vec<Found>) {
        for lane in 0..WIDTH {
            let ending = match self.state[lane] {
                state::HIT => self.hit(lane),
                state::REFUTED => Ending::broken(self.last_t[lane], self.steps[lane] as u32),
                state::SINGLE => self.single(lane, rules, marched),
                _ => continue,
            };
            self.state[lane] = state::IDLE;
            sink.push(Found { lane, ending });
        }
    }

    fn hit(&self, lane: usize) -> Ending {
        let (low, high) = (self.last_t[lane], self.high_t[lane]);
        let (a, b) = (self.last_value[lane], self.high_value[lane]);
        let grid = self.grid[lane];
        let width = high - low;
        let is_on_grid = (low / grid).fract() == 0.0 && width == grid;
        let is_by_tangents = self.error[lane] > 0.0;
        let t = if is_by_tangents {
            self.t[lane]
        } else if b == 0.0 {
            high
        } else if is_on_grid {
            low + a / (a - b) * width
        } else {
            low + 0.5 * width
        };
        let error = if is_by_tangents {
            self.error[lane]
        } else {
            width.max(finest(self.size[lane], t))
        };
        Ending {
            verdict: Verdict::Hit,
            t,
            error,
            steps: self.steps[lane] as u32,
        }
    }

    /// Walks a lane to its end outside of the lanes.
    fn single(&mut self, lane: usize, rules: &Rules, marched: &Marched) -> Ending {
        let segment = self.segment(lane, rules, marched);
        let axis = |columns: &[Lane; 3]| DVec3::from_array([0, 1, 2].map(|i| columns[i][lane]));
        let ray = Ray {
            origin: axis(&self.origin),
            direction: axis(&self.direction),
            t_max: segment.end,
            footprint: segment.footprint,
        };
        let ending = match &marched.slope {
            Some(slope) => self.single_by_tangents(lane, &ray, segment, slope),
            None => self.single_by_steps(lane, &ray, segment, marched),
        };
        let (ending, evaluations) = decided(marched, &ray, segment, ending);
        self.evaluations[lane] += i64::from(evaluations);
        ending
    }

    fn single_by_tangents(
        &mut self,
        lane: usize,
        ray: &Ray,
        segment: Segment,
        slope: &Slope,
    ) -> Ending {
        let mut walk = Convex::begin(segment);
        self.evaluations[lane] = 0;
        loop {
            let (p, d) = (ray.at(walk.t()), ray.direction);
            let along = |value: f64, rate: f64| Dual::new(value, [rate]);
            let place = Vec3::new(along(p.x, d.x), along(p.y, d.y), along(p.z, d.z));
            let field = (slope.single)(&place);
            self.evaluations[lane] += 1;
            if let Some(ending) = walk.observe(field.value, field.partial[0]) {
                return ending;
            }
        }
    }

    fn single_by_steps(
        &mut self,
        lane: usize,
        ray: &Ray,
        segment: Segment,
        marched: &Marched,
    ) -> Ending {
        let has_last = self.has_last[lane] != 0;
        let mut walk = Certified::resume(
            segment,
            has_last.then_some((self.last_t[lane], self.last_value[lane])),
            self.t[lane],
            self.departed[lane] != 0,
            self.steps[lane] as u32 - 1,
            self.far[lane],
        );
        // The sample that the lane could not go on from is taken again.
        self.evaluations[lane] -= 1;
        loop {
            let p = ray.at(walk.t());
            self.evaluations[lane] += 1;
            let value = (marched.single)(&Vec3::new(p.x, p.y, p.z));
            if let Some(ending) = walk.observe(value, 0.0) {
                return ending;
            }
        }
    }

    /// What a lane walks along, for a walk outside of the lanes.
    fn segment(&self, lane: usize, rules: &Rules, marched: &Marched) -> Segment {
        Segment {
            start: self.start[lane],
            end: self.end[lane],
            lipschitz: rules.lipschitz,
            footprint: Footprint {
                at_origin: self.footprint[lane],
                spread: self.spread[lane],
            },
            tolerance: rules.tolerance,
            max_steps: rules.max_steps,
            size: self.size[lane],
            is_sheet: marched.is_sheet,
            is_endless: rules.is_endless,
        }
    }
}

/// Where a ray walks: its way through the region, with room for the rounding of places along it.
fn stretch(bundle: &Bundle, ray: usize, origin: f64) -> (f64, f64) {
    let slack = |t: f64| 32.0 * f64::EPSILON * (origin + t);
    let (enter, leave) = (bundle.enter[ray], bundle.leave[ray]);
    let start = (enter - slack(enter)).max(0.0);
    let end = if leave == bundle.t_max[ray] {
        leave
    } else {
        leave + slack(leave)
    };
    (start, end)
}

/// The spacing of the places where a ray's hits are enclosed: a power of two that depends on the ray and the part alone.
fn grid(start: f64, size: f64, rules: &Rules, footprint: f64, spread: f64) -> f64 {
    let t = start.max(size * NEAR);
    // Where a pixel is wider than the whole shape, the shape is the measure.
    let tolerance = (rules.tolerance * (footprint + spread * t)).min(rules.extent);
    power_of_two((GRID * tolerance).max(2.0 * finest(size, 2.0 * size)))
}

/// The largest power of two that is not above `x`.
fn power_of_two(x: f64) -> f64 {
    let exponent = x.to_bits() & (0x7ff << 52);
    f64::from_bits(exponent).max(f64::MIN_POSITIVE)
}

/// The smallest difference of distances that rounding leaves at `t`.
#[inline(always)]
pub(super) fn finest(size: f64, t: f64) -> f64 {
    4.0 * f64::EPSILON * if size > t { size } else { t }
}

fn is_walking(state: i64) -> bool {
    matches!(state, state::FRESH | state::MARCHING | state::ARRIVED)
}

#[inline(always)]
fn places(origin: &[Lane; 3], direction: &[Lane; 3], t: &Lane) -> Vec3<F64x32> {
    let mut p = [[0.0; WIDTH]; 3];
    for axis in 0..3 {
        for lane in 0..WIDTH {
            p[axis][lane] = origin[axis][lane] + direction[axis][lane] * t[lane];
        }
    }
    let [x, y, z] = p;
    Vec3::new(Lanes(x), Lanes(y), Lanes(z))
}

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

/// If no more lanes than this go on, those that lag behind are walked one by one, at 32 places at once.
const STRAGGLERS: i64 = 3;

/// A lane lags behind after so many evaluations.
const PATIENCE: i64 = 24;

/// How often a lane may be asked for 32 places before it goes on by itself.
const MAX_FANS: usize = 256;

impl Packet {
    /// Whether a lane steps along close to a surface, and has done so for long.
    #[inline(always)]
    fn lags(&self, lane: usize, rules: &Rules) -> bool {
        let is_stepping = matches!(self.state[lane], state::MARCHING | state::PROBING);
        is_stepping
            && self.evaluations[lane] >= PATIENCE
            && self.departed[lane] != 0
            && self.last_value[lane].abs() <= 2.0 * rules.lipschitz * self.epsilon(lane, rules)
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
/// has to be known to be free, as every step.
#[inline(always)]
fn fan(packet: &mut Packet, lane: usize, value: &Closure<F64x32>, rules: &Rules) {
    let p = packet;
    let slope = rules.lipschitz;
    let [origin, direction] =
        [&p.origin, &p.direction].map(|c| [0, 1, 2].map(|i| [c[i][lane]; WIDTH]));
    let limit = p.limit[lane];
    let (mut last_t, mut last) = (p.last_t[lane], p.last_value[lane]);
    // The gap that was not free in the fan before.
    let mut doubt = f64::INFINITY;
    for _ in 0..MAX_FANS {
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
            return;
        }
        let rounding = finest(p.size[lane], last_t);
        let width = if doubt < f64::INFINITY {
            doubt / WIDTH as f64
        } else {
            (SHYNESS * free).max(epsilon / WIDTH as f64)
        };
        let width = width.max(rounding);
        doubt = f64::INFINITY;
        let mut t = [0.0; WIDTH];
        for k in 0..WIDTH {
            let place = last_t + width * (k + 1) as f64;
            t[k] = if place < limit { place } else { limit };
        }
        let values = value(&places(&origin, &direction, &t)).0;
        p.evaluations[lane] += WIDTH as i64;
        for k in 0..WIDTH {
            let now = values[k];
            let gap = t[k] - last_t;
            let sum = last.abs() + now.abs();
            let differs = now != 0.0 && (now < 0.0) != (last < 0.0);
            let noise = 64.0 * f64::EPSILON * (p.size[lane] + t[k]) * slope;
            if (now - last).abs() > slope * gap * (1.0 + 1e-9) + noise {
                p.state[lane] = state::REFUTED;
                return;
            }
            if now.is_nan() || now == 0.0 {
                p.state[lane] = state::SINGLE;
                p.t[lane] = t[k];
                return;
            }
            if differs && sum + slope * epsilon >= slope * gap * (1.0 - 1e-9) {
                (p.high_t[lane], p.high_value[lane]) = (t[k], now);
                p.narrowings[lane] = 0;
                p.state[lane] = state::ENCLOSING;
                p.t[lane] = last_t + 0.5 * gap;
                return;
            }
            if differs || (sum < slope * gap * (1.0 - 1e-9) && gap > rounding) {
                // The next fan looks closer from here.
                doubt = gap;
                break;
            }
            (last_t, last) = (t[k], now);
            (p.last_t[lane], p.last_value[lane]) = (last_t, last);
            p.side[lane] = if now < 0.0 { -1.0 } else { 1.0 };
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

/// Lets every lane observe its value; gives how many go on.
#[inline(always)]
fn step(packet: &mut Packet, values: &Lane, rules: &Rules) -> i64 {
    let p = packet;
    let slope = rules.lipschitz;
    let inverse = 1.0 / slope;
    let max_steps = i64::from(rules.max_steps);
    let mut going = 0;
    for i in 0..WIDTH {
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
        let is_narrow = sum + slope * tolerance >= slope * width * (1.0 - 1e-9);
        let is_crossing = has_last && differs && (is_narrow || !has_departed);
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
        let starts_anew = is_marching && (begins || marched == state::MARCHING);
        let narrowings = if starts_anew { 0 } else { p.narrowings[i] };
        let is_done = top_value == 0.0 || span <= grid || narrowings >= MAX_NARROWINGS;
        let secant = low_t + low_value / (low_value - top_value) * span;
        let middle = low_t + 0.5 * span;
        let is_within = secant >= low_t && secant <= top_t;
        let inner = if narrowings % 3 == 2 || !is_within {
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
