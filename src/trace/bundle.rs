//! Bundles: up to 256 rays with what they found so far, side by side in arrays, so that lanes work on all of them.

use super::analytic::{ClosedForm, Crossing};
use super::{Outcome, Ray, Verdict};
use crate::catalogue::Bounds;
use crate::field::Task;
use glam::DVec3;

/// How many rays a bundle holds: a block of 16 x 16 pixels.
pub(super) const CAPACITY: usize = 256;

/// How many lanes work at once.
pub(super) const WIDTH: usize = 32;

/// The number of no part.
const NONE: u32 = u32::MAX;

/// A number for each ray.
pub(super) type Column = [f64; CAPACITY];

/// Rays and what they found.
pub(super) struct Bundle {
    /// How many rays there are.
    pub count: usize,
    /// Their origins, by axis.
    pub origin: [Column; 3],
    /// Their directions.
    pub direction: [Column; 3],
    inverse: [Column; 3],
    /// How far each ray is still to be followed: to the nearest hit so far; negative where nothing is left to do.
    pub limit: Column,
    /// How far each ray was to be followed at first.
    pub t_max: Column,
    /// The widths of the pixels at the origins.
    pub footprint: Column,
    /// By how much they grow with each scene unit.
    pub spread: Column,
    /// The distances of the nearest hits.
    pub t: Column,
    /// Their errors.
    pub error: Column,
    /// The gradients there, not normalised; zero where they are still to be found.
    pub gradient: [Column; 3],
    /// The parts that were hit.
    pub part: [u32; CAPACITY],
    /// How far each ray is known to be free where a walk could not tell; else infinite.
    pub unknown: Column,
    /// Steps taken.
    pub steps: [u32; CAPACITY],
    /// Evaluations of fields.
    pub evaluations: [u32; CAPACITY],
    /// Where rays enter a box.
    pub enter: Column,
    /// Where they leave it; below the entry for those that miss it.
    pub leave: Column,
}

impl Bundle {
    /// An empty bundle: large, so it lives in a box and is filled again and again.
    pub fn new() -> Box<Self> {
        let column = [0.0; CAPACITY];
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
            gradient: [column; 3],
            part: [NONE; CAPACITY],
            unknown: column,
            steps: [0; CAPACITY],
            evaluations: [0; CAPACITY],
            enter: column,
            leave: column,
        })
    }

    /// Takes the rays with these numbers, at most [`CAPACITY`], and forgets what was there.
    pub fn fill(&mut self, rays: &[Ray], numbers: &[u32]) {
        self.count = numbers.len();
        for (i, number) in numbers.iter().enumerate() {
            let ray = &rays[*number as usize];
            let inverse = ray.direction.recip();
            for axis in 0..3 {
                self.origin[axis][i] = ray.origin[axis];
                self.direction[axis][i] = ray.direction[axis];
                self.inverse[axis][i] = inverse[axis];
            }
            self.t_max[i] = ray.t_max;
            self.footprint[i] = ray.footprint.at_origin;
            self.spread[i] = ray.footprint.spread;
        }
        let n = self.count.next_multiple_of(WIDTH);
        self.limit[..self.count].copy_from_slice(&self.t_max[..numbers.len()]);
        // Lanes without a ray take part in nothing.
        self.limit[self.count..n].fill(-1.0);
        self.t[..n].fill(f64::INFINITY);
        self.error[..n].fill(0.0);
        for axis in &mut self.gradient {
            axis[..n].fill(0.0);
        }
        self.part[..n].fill(NONE);
        self.unknown[..n].fill(f64::INFINITY);
        self.steps[..n].fill(0);
        self.evaluations[..n].fill(0);
    }

    /// How far the farthest of the rays is still to be followed; negative where nothing is left to do.
    pub fn farthest(&self) -> f64 {
        self.limit[..self.count].iter().fold(-1.0, |a, b| a.max(*b))
    }

    /// Takes a hit if it is nearer than what the ray has; of two at the same place, that on the part declared first.
    /// With `any`, the ray is content with it.
    pub fn offer(&mut self, ray: usize, found: Crossing, part: u32, any: bool) -> bool {
        if self.part[ray] != NONE {
            let (best, its_error) = (self.t[ray], self.error[ray]);
            let margin = found.error.min(its_error) + 4.0 * f64::EPSILON * best;
            let is_nearer = if (found.t - best).abs() <= margin {
                part < self.part[ray]
            } else {
                found.t < best
            };
            if !is_nearer {
                return false;
            }
        }
        self.t[ray] = found.t;
        self.error[ray] = found.error;
        (0..3).for_each(|axis| self.gradient[axis][ray] = 0.0);
        self.part[ray] = part;
        self.limit[ray] = if any {
            -1.0
        } else {
            (found.t + found.error).min(self.t_max[ray])
        };
        true
    }

    /// The verdict on a ray.
    pub fn verdict(&self, ray: usize) -> Verdict {
        let has_hit = self.part[ray] != NONE;
        // A hit counts only if the ray is known to be free before it.
        if has_hit && self.unknown[ray] >= self.t[ray] {
            Verdict::Hit
        } else if self.unknown[ray] < f64::INFINITY {
            Verdict::Unknown
        } else {
            Verdict::Miss
        }
    }

    /// The verdict on a ray that is content with any hit.
    pub fn any_verdict(&self, ray: usize) -> Verdict {
        if self.part[ray] != NONE {
            Verdict::Hit
        } else {
            self.verdict(ray)
        }
    }

    /// The outcome of a ray, with the direction of the gradient as normal.
    pub fn outcome(&self, number: usize, ray: &Ray) -> Outcome {
        let verdict = self.verdict(number);
        let mut outcome = Outcome {
            verdict,
            steps: self.steps[number],
            evaluations: self.evaluations[number],
            ..Outcome::NOTHING
        };
        match verdict {
            Verdict::Hit => {
                outcome.t = self.t[number];
                outcome.error = self.error[number];
                outcome.point = ray.at(outcome.t);
                outcome.part = self.part[number];
            }
            Verdict::Unknown => {
                outcome.t = self.unknown[number];
                outcome.error = f64::INFINITY;
            }
            Verdict::Miss => {}
        }
        outcome
    }
}

/// Finds where the rays of a bundle enter and leave a box. As [`super::hierarchy::clip`], which has the sources.
pub(super) struct Clip<'a> {
    /// The rays.
    pub bundle: &'a mut Bundle,
    /// The box.
    pub bounds: &'a Bounds,
}

impl Task for Clip<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let b = self.bundle;
        let n = b.count.next_multiple_of(WIDTH);
        for i in 0..n.min(CAPACITY) {
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
        }
    }
}

/// Asks where the rays of a bundle enter a surface.
pub(super) struct Enter<'a, F> {
    /// The rays; the entries are written to `enter`, the errors to `leave`.
    pub bundle: &'a mut Bundle,
    /// The surface.
    pub form: &'a F,
}

impl<F: ClosedForm> Task for Enter<'_, F> {
    /// Whether any ray may meet the surface; if not, nothing was written.
    type Output = bool;

    #[inline(always)]
    fn run(self) -> bool {
        let b = self.bundle;
        let n = b.count.next_multiple_of(WIDTH).min(CAPACITY);
        let mut is_met = false;
        for i in 0..n {
            let (o, d) = (place(&b.origin, i), place(&b.direction, i));
            is_met |= self.form.may_meet(o, d);
        }
        if !is_met {
            return false;
        }
        for i in 0..n {
            let (o, d) = (place(&b.origin, i), place(&b.direction, i));
            let (t, error) = self.form.crossing(o, d);
            b.enter[i] = if t <= b.limit[i] { t } else { f64::INFINITY };
            b.leave[i] = error;
        }
        true
    }
}

/// The place of a ray.
#[inline(always)]
fn place(columns: &[Column; 3], i: usize) -> DVec3 {
    DVec3::new(columns[0][i], columns[1][i], columns[2][i])
}
