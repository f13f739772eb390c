//! Bundles: up to 256 rays with what they found so far, side by side in arrays, so that lanes work on all of them.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::analytic::{ClosedForm, Crossing};
use super::bits::ones;
use super::cones::{ALL, PACKETS, Packets};
use super::finding::{Finding, concluded, is_better, occluded};
use super::vector::place;
use super::{RayColumns, Verdict};
use crate::catalogue::Bounds;
use crate::field::{Level, Task, run_at};
use crate::num::{BATCH, Column, F64x32, ROOM, Rows};
use std::mem;

/// How many lanes work at once.
pub(super) const WIDTH: usize = F64x32::WIDTH;

/// Rays and what they found. Every column begins with a cache line.
#[repr(C, align(64))]
pub(super) struct Bundle {
    /// Their origins, by axis.
    pub origin: [Column; 3],
    /// Their directions.
    pub direction: [Column; 3],
    inverse: [Column; 3],
    /// How far each ray is still to be followed: to the nearest hit so far; negative where nothing is left to do.
    pub limit: Column,
    /// How far each ray was to be followed at first.
    pub t_max: Column,
    /// The widths of the pixels at the origins, once they are measured.
    pub footprint: Column,
    /// By how much they grow with each scene unit.
    pub spread: Column,
    /// The nearest hits; infinitely far where there is none.
    pub t: Column,
    error: Column,
    part: [u64; BATCH],
    unknown: Column,
    /// Steps taken.
    pub steps: [u32; BATCH],
    /// Evaluations of fields.
    pub evaluations: [u32; BATCH],
    /// The gradients at their hits, not normalised; zero where they are still to be found.
    pub gradient: [Column; 3],
    /// The places of their hits; zero where there is none.
    pub point: [Column; 3],
    /// The parts that were hit; 0 where there is no hit.
    pub hit: [u32; BATCH],
    /// Where rays enter a box.
    pub enter: Column,
    /// Where they leave it; below the entry for those that miss it.
    pub leave: Column,
    /// Whether they meet it, or what else was asked last.
    pub meets: [u8; BATCH],
    /// How many rays there are.
    pub count: usize,
    /// Whether the reciprocals of the directions are there.
    is_inverted: bool,
    /// Whether the widths of the pixels are there.
    is_measured: bool,
    /// Whether gradients, doubts and counts are not those of rays that have found nothing.
    is_marked: bool,
    /// The parts in closed form that rays were content with for a while, each once.
    pub winners: Vec<u32>,
}

impl Bundle {
    /// An empty bundle: large, so it lives in a box and is filled again and again.
    pub fn new() -> Box<Self> {
        let column = [0.0; ROOM];
        Box::new(Self {
            count: 0,
            origin: [column; 3],
            direction: [column; 3],
            inverse: [column; 3],
            limit: column,
            t_max: column,
            footprint: column,
            spread: column,
            t: column,
            error: column,
            part: [0; BATCH],
            unknown: column,
            steps: [0; BATCH],
            evaluations: [0; BATCH],
            gradient: [column; 3],
            point: [column; 3],
            hit: [0; BATCH],
            enter: column,
            leave: column,
            meets: [0; BATCH],
            is_inverted: false,
            is_measured: false,
            is_marked: true,
            winners: Vec::new(),
        })
    }

    /// Takes the rays with these numbers, from 1 to [`BATCH`] of them, in order, but for the widths of their pixels, and
    /// forgets what was there.
    pub fn fill(&mut self, rays: &RayColumns, numbers: &[u32]) {
        self.count = numbers.len();
        let n = self.lanes();
        let ([a, b, c], [d, e, f]) = (&mut self.origin, &mut self.direction);
        let lanes = [a, b, c, d, e, f, &mut self.t_max];
        let [ways @ .., _, _] = *rays;
        take(lanes, ways, (numbers, n));
        (self.is_inverted, self.is_measured) = (false, false);
        self.winners.clear();
        self.limit[..n].copy_from_slice(&self.t_max[..n]);
        // They take part in nothing.
        self.limit[self.count..n].fill(-1.0);
        self.t[..n].fill(f64::INFINITY);
        if mem::take(&mut self.is_marked) {
            self.unknown.fill(f64::INFINITY);
            self.steps.fill(0);
            self.evaluations.fill(0);
            self.gradient.iter_mut().for_each(|axis| axis.fill(0.0));
        }
    }

    /// Takes the widths of the pixels too, which only marched rays ask for, unless they are there; of the same rays.
    pub fn measure(&mut self, rays: &RayColumns, numbers: &[u32]) {
        if !mem::replace(&mut self.is_measured, true) {
            let count = self.lanes();
            let [.., footprint, spread] = *rays;
            let lanes = [&mut self.footprint, &mut self.spread];
            take(lanes, [footprint, spread], (numbers, count));
        }
    }

    /// Says that what only marched rays and normals write is going to be written.
    pub fn mark(&mut self) {
        self.is_marked = true;
    }

    /// Whether no ray has met anything, or been walked.
    pub fn is_blank(&self) -> bool {
        self.winners.is_empty() && !self.is_marked
    }

    /// Its packets.
    pub fn packets(&self) -> Packets {
        ALL >> (PACKETS - self.lanes() / WIDTH)
    }

    /// How many lanes are in use: the rays, rounded up to whole packets.
    #[inline(always)]
    pub fn lanes(&self) -> usize {
        self.count.next_multiple_of(WIDTH).min(BATCH)
    }

    /// What a ray found so far.
    pub fn finding(&self, ray: usize) -> Finding {
        Finding {
            best: Crossing {
                t: self.t[ray],
                error: self.error[ray],
            },
            part: self.part[ray] as u32,
            unknown: self.unknown[ray],
            steps: self.steps[ray],
            evaluations: self.evaluations[ray],
        }
    }

    /// Offers a hit to a ray, as [`Finding::offer`]. With `any`, the ray is content with it.
    pub fn offer(&mut self, ray: usize, found: Crossing, part: u32, any: bool) -> bool {
        let mut finding = self.finding(ray);
        let is_taken = finding.offer(found, part);
        if is_taken {
            (self.t[ray], self.error[ray], self.part[ray]) = (found.t, found.error, part.into());
            (0..3).for_each(|axis| self.gradient[axis][ray] = 0.0);
            self.limit[ray] = if any {
                -1.0
            } else {
                finding.limit(self.t_max[ray])
            };
        }
        is_taken
    }

    /// Finds where the rays in some packets enter and leave a box, in `enter` and `leave`, and which of them meet it.
    pub fn clip(&mut self, bounds: &Bounds, packets: Packets, level: Level) {
        if !self.is_inverted {
            run_at(level, Invert(self));
            self.is_inverted = true;
        }
        let bundle = self;
        let task = Clip {
            bundle,
            bounds,
            packets,
        };
        run_at(level, task);
    }

    /// Draws the conclusions of all rays: verdicts, with distances in `enter`, errors in `leave`, places in `point`, parts in
    /// `hit`, and normals in `gradient`, zero where they are still to be found; then the ray counts as one that meets something.
    pub fn conclude(&mut self, level: Level) -> [Verdict; BATCH] {
        run_at(level, Conclude(self))
    }

    /// The verdicts on rays that are content with any hit.
    pub fn blocked(&self, level: Level) -> [Verdict; BATCH] {
        run_at(level, Blocked(self))
    }

    /// Finds the normals of the hits on part `number`, which has this form.
    pub fn turn<F: ClosedForm>(&mut self, form: &F, number: u32, level: Level) {
        self.mark();
        let bundle = self;
        let task = Normals {
            bundle,
            form,
            number,
        };
        run_at(level, task);
    }

    /// Collects the rays that meet something, by what was asked last.
    pub fn meeting(&self, rays: &mut Vec<u32>) {
        rays.clear();
        for (k, meets) in self.meets[..self.lanes()].chunks_exact(8).enumerate() {
            // Most boxes are met by few rays.
            if meets != [0; 8] {
                let met = (0..8).filter(|i| meets[*i] != 0);
                rays.extend(met.map(|i| (8 * k + i) as u32));
            }
        }
    }

    /// A walk of a ray could not tell; up to `free` it could.
    pub fn doubt(&mut self, ray: usize, free: f64) {
        self.unknown[ray] = self.unknown[ray].min(free);
    }
}

/// Takes what columns have at these numbers, which are in order, into as many lanes: those without a ray repeat the first.
fn take<const N: usize>(
    lanes: [&mut Column; N],
    columns: [&[f64]; N],
    (numbers, count): (&[u32], usize),
) {
    let rows = Rows::in_order(numbers);
    for (lanes, column) in lanes.into_iter().zip(columns) {
        rows.take(column, lanes);
        let first = lanes[0];
        lanes[numbers.len()..count].fill(first);
    }
}

/// Up to [`WIDTH`] rays of a bundle, for lanes: those without a ray repeat the first, so that they cost nothing unusual.
pub(super) struct Choice {
    places: [usize; WIDTH],
    /// Where they begin if they are [`WIDTH`] neighbours.
    first: Option<usize>,
}

impl Choice {
    /// These rays, at least one, in any order.
    #[inline(always)]
    pub fn of(rays: &[u32]) -> Self {
        let mut places = [0; WIDTH];
        for lane in 0..WIDTH {
            let ray = rays[if lane < rays.len() { lane } else { 0 }];
            places[lane] = ray as usize % BATCH;
        }
        let first = places[0];
        let mut others = 0;
        for lane in 0..WIDTH {
            others |= places[lane] ^ (first + lane);
        }
        let are_neighbours = others == 0;
        Self {
            places,
            first: are_neighbours.then_some(first.min(BATCH - WIDTH)),
        }
    }

    /// Which ray each lane has.
    #[inline(always)]
    pub fn rays(&self) -> [u32; WIDTH] {
        let mut rays = [0; WIDTH];
        for lane in 0..WIDTH {
            rays[lane] = self.places[lane] as u32;
        }
        rays
    }

    /// Their numbers in a column.
    #[inline(always)]
    pub fn picked(&self, column: &Column) -> [f64; WIDTH] {
        let mut lanes = [0.0; WIDTH];
        if let Some(first) = self.first {
            lanes.copy_from_slice(&column[first..first + WIDTH]);
            return lanes;
        }
        for lane in 0..WIDTH {
            lanes[lane] = column[self.places[lane] % BATCH];
        }
        lanes
    }
}

/// Finds the reciprocals of the directions.
struct Invert<'a>(&'a mut Bundle);

impl Task for Invert<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let b = self.0;
        for axis in 0..3 {
            for i in 0..b.lanes() {
                b.inverse[axis][i] = 1.0 / b.direction[axis][i];
            }
        }
    }
}

/// The larger of two numbers; the second if one is none.
#[inline(always)]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The lesser of two numbers; the second if one is none.
#[inline(always)]
pub(super) fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// What `join` makes of `first` and some numbers, of which there are a multiple of [`WIDTH`], in any order. For one `join` at a
/// time: the lanes then stay in registers.
#[inline(always)]
pub(super) fn fold(numbers: &[f64], first: f64, join: impl Fn(f64, f64) -> f64) -> f64 {
    /// Two registers of the widest instructions.
    const LANES: usize = 16;
    let mut lanes = [first; LANES];
    for some in numbers.as_chunks::<LANES>().0 {
        for lane in 0..LANES {
            lanes[lane] = join(some[lane], lanes[lane]);
        }
    }
    let mut half = LANES / 2;
    while half > 0 {
        for lane in 0..half {
            lanes[lane] = join(lanes[lane], lanes[lane + half]);
        }
        half /= 2;
    }
    lanes[0]
}

/// As [`Bundle::conclude`].
struct Conclude<'a>(&'a mut Bundle);

impl Task for Conclude<'_> {
    type Output = [Verdict; BATCH];

    #[inline(always)]
    fn run(self) -> [Verdict; BATCH] {
        let b = self.0;
        let mut verdicts = [Verdict::Miss; BATCH];
        for i in 0..b.lanes() {
            let best = Crossing {
                t: b.t[i],
                error: b.error[i],
            };
            (verdicts[i], b.enter[i], b.leave[i]) = concluded(best, b.unknown[i]);
            let is_hit = verdicts[i] == Verdict::Hit;
            for axis in 0..3 {
                let place = b.origin[axis][i] + b.direction[axis][i] * b.enter[i];
                b.point[axis][i] = if is_hit { place } else { 0.0 };
            }
            b.hit[i] = if is_hit { b.part[i] as u32 } else { 0 };
            b.meets[i] = u8::from(is_hit);
        }
        for first in (0..b.lanes()).step_by(WIDTH) {
            let first = first.min(BATCH - WIDTH);
            // Closed forms leave no gradients.
            let mut is_any = false;
            for i in first..first + WIDTH {
                is_any |= (b.gradient[0][i] != 0.0)
                    | (b.gradient[1][i] != 0.0)
                    | (b.gradient[2][i] != 0.0);
            }
            if is_any {
                normalise(b, first);
            }
        }
        verdicts
    }
}

/// Makes unit normals of the gradients of a packet of hits.
#[inline(always)]
fn normalise(b: &mut Bundle, first: usize) {
    // As wide as the other lanes: bytes beside numbers would be taken lane by lane.
    let (mut hits, mut open) = ([0.0; WIDTH], [0u64; WIDTH]);
    for lane in 0..WIDTH {
        hits[lane] = f64::from(b.meets[first + lane]);
    }
    for lane in 0..WIDTH {
        let i = first + lane;
        let [x, y, z] = [b.gradient[0][i], b.gradient[1][i], b.gradient[2][i]];
        let scale = 1.0 / (x * x + y * y + z * z).sqrt();
        let is_hit = hits[lane] != 0.0;
        let is_scale = is_hit & (scale > 0.0) & (scale <= f64::MAX);
        let [x, y, z] = [x * scale, y * scale, z * scale];
        let x = if is_scale { x } else { 0.0 };
        let y = if is_scale { y } else { 0.0 };
        let z = if is_scale { z } else { 0.0 };
        (b.gradient[0][i], b.gradient[1][i], b.gradient[2][i]) = (x, y, z);
        open[lane] = u64::from(is_hit & (x == 0.0) & (y == 0.0) & (z == 0.0));
    }
    for lane in 0..WIDTH {
        b.meets[first + lane] = open[lane] as u8;
    }
}

/// Finds the normals of the hits on a part in closed form.
struct Normals<'a, F> {
    bundle: &'a mut Bundle,
    form: &'a F,
    number: u32,
}

impl<F: ClosedForm> Task for Normals<'_, F> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let b = self.bundle;
        let number = u64::from(self.number);
        for first in (0..b.lanes()).step_by(WIDTH) {
            let first = first.min(BATCH - WIDTH);
            let mut is_any = false;
            for i in first..first + WIDTH {
                is_any |= b.part[i] == number;
            }
            if !is_any {
                continue;
            }
            for i in first..first + WIDTH {
                let normal = self.form.normal(place(&b.point, i), place(&b.direction, i));
                let is_here = (b.meets[i] != 0) & (b.part[i] == number);
                for axis in 0..3 {
                    let before = b.gradient[axis][i];
                    b.gradient[axis][i] = if is_here { normal[axis] } else { before };
                }
                b.meets[i] = if is_here { 0 } else { b.meets[i] };
            }
        }
    }
}

/// As [`Bundle::blocked`].
struct Blocked<'a>(&'a Bundle);

impl Task for Blocked<'_> {
    type Output = [Verdict; BATCH];

    #[inline(always)]
    fn run(self) -> [Verdict; BATCH] {
        let mut verdicts = [Verdict::Miss; BATCH];
        for i in 0..self.0.lanes() {
            let best = Crossing {
                t: self.0.t[i],
                error: self.0.error[i],
            };
            verdicts[i] = occluded(best, self.0.unknown[i]);
        }
        verdicts
    }
}

/// As [`Bundle::clip`], and [`super::hierarchy::clip`], which has the sources.
struct Clip<'a> {
    bundle: &'a mut Bundle,
    bounds: &'a Bounds,
    packets: Packets,
}

impl Task for Clip<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let b = self.bundle;
        b.meets = [0; BATCH];
        for k in ones(self.packets) {
            let first = (k * WIDTH).min(BATCH - WIDTH);
            for i in first..first + WIDTH {
                let (mut enter, mut leave) = (0.0f64, b.limit[i]);
                for axis in 0..3 {
                    let (o, inverse) = (b.origin[axis][i], b.inverse[axis][i]);
                    let first = (self.bounds.low[axis] - o) * inverse;
                    let second = (self.bounds.high[axis] - o) * inverse;
                    // Not a number where a ray runs within a face: then the face does not cut it.
                    let is_number = first <= second || second <= first;
                    let near = if first < second { first } else { second };
                    let far = if first < second { second } else { first };
                    let near = if is_number { near } else { f64::NEG_INFINITY };
                    let far = if is_number { far } else { f64::INFINITY };
                    let near = near * (1.0 - 4.0 * f64::EPSILON);
                    let far = far * (1.0 + 4.0 * f64::EPSILON);
                    enter = if near > enter { near } else { enter };
                    leave = if far < leave { far } else { leave };
                }
                b.enter[i] = enter;
                b.leave[i] = leave;
                b.meets[i] = u8::from(enter <= leave);
            }
        }
    }
}

/// Asks where the rays of a bundle enter a surface, and takes that as hits.
pub(super) struct Enter<'a, F> {
    /// The rays.
    pub bundle: &'a mut Bundle,
    /// The surface.
    pub form: &'a F,
    /// The part that it is.
    pub number: u32,
    /// The packets that may meet it.
    pub packets: Packets,
    /// Whether the rays are content with any hit.
    pub any: bool,
}

impl<F: ClosedForm> Task for Enter<'_, F> {
    /// Whether any hit is new.
    type Output = bool;

    /// As [`Bundle::offer`] for each ray.
    #[inline(always)]
    fn run(mut self) -> bool {
        let mut is_new = false;
        for k in ones(self.packets) {
            let first = (k * WIDTH).min(BATCH - WIDTH);
            let mut is_met = false;
            for i in first..first + WIDTH {
                let (o, d) = (
                    place(&self.bundle.origin, i),
                    place(&self.bundle.direction, i),
                );
                is_met |= self.form.may_meet(o, d);
            }
            if is_met {
                is_new |= if self.any {
                    self.block(first)
                } else {
                    self.cross(first)
                };
            }
        }
        is_new
    }
}

impl<F: ClosedForm> Enter<'_, F> {
    /// Asks a packet of rays; gives whether any hit is new.
    #[inline(always)]
    fn cross(&mut self, first: usize) -> bool {
        let b = &mut *self.bundle;
        let number = u64::from(self.number);
        let mut taken = [0u64; WIDTH];
        for lane in 0..WIDTH {
            let i = first + lane;
            let (o, d) = (place(&b.origin, i), place(&b.direction, i));
            let (t, error) = self.form.crossing(o, d);
            let (found, best) = (
                Crossing { t, error },
                Crossing {
                    t: b.t[i],
                    error: b.error[i],
                },
            );
            let is_taken = (t <= b.limit[i]) & is_better(found, number, best, b.part[i]);
            taken[lane] = u64::from(is_taken);
            b.t[i] = if is_taken { t } else { b.t[i] };
            b.error[i] = if is_taken { error } else { b.error[i] };
            b.part[i] = if is_taken { number } else { b.part[i] };
            let end = t + error;
            let end = if end < b.t_max[i] { end } else { b.t_max[i] };
            b.limit[i] = if is_taken { end } else { b.limit[i] };
        }
        if b.is_marked {
            for axis in 0..3 {
                for lane in 0..WIDTH {
                    let before = b.gradient[axis][first + lane];
                    b.gradient[axis][first + lane] = if taken[lane] != 0 { 0.0 } else { before };
                }
            }
        }
        sum(&taken) > 0
    }

    /// As [`Enter::cross`] for rays that are content with any hit: neither how far off it may be nor what it hits is asked.
    #[inline(always)]
    fn block(&mut self, first: usize) -> bool {
        let b = &mut *self.bundle;
        let mut taken = [0u64; WIDTH];
        for lane in 0..WIDTH {
            let i = first + lane;
            let (t, _) = self
                .form
                .crossing(place(&b.origin, i), place(&b.direction, i));
            let is_taken = (t <= b.limit[i]) & (t < f64::INFINITY);
            taken[lane] = u64::from(is_taken);
            b.t[i] = if is_taken { t } else { b.t[i] };
            b.limit[i] = if is_taken { -1.0 } else { b.limit[i] };
        }
        sum(&taken) > 0
    }
}

/// The sum of a packet's numbers.
#[inline(always)]
fn sum(numbers: &[u64; WIDTH]) -> u64 {
    let mut sum = 0;
    for lane in 0..WIDTH {
        sum += numbers[lane];
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_have_the_numbers_of_the_rays_that_were_chosen() {
        let column: Column = std::array::from_fn(|i| i as f64);
        let neighbours: Vec<u32> = (64..96).collect();
        let mut swapped = neighbours.clone();
        swapped.swap(3, 20);
        let ends: Vec<u32> = (0..31).map(|i| 2 * i).chain([31]).collect();
        for rays in [neighbours, swapped, ends, vec![7], (224..255).collect()] {
            let choice = Choice::of(&rays);
            let lane = |k: usize| rays[if k < rays.len() { k } else { 0 }];
            assert_eq!(choice.rays(), std::array::from_fn(lane));
            let numbers = choice.picked(&column);
            assert_eq!(numbers, std::array::from_fn(|k| f64::from(lane(k))));
        }
    }
}
