//! Bundles: up to 256 rays with what they found so far, side by side in arrays, so that lanes work on all of them.

use super::Ray;
use super::analytic::{ClosedForm, Crossing};
use super::finding::Finding;
use crate::catalogue::Bounds;
use crate::field::Task;
use crate::num::F64x32;
use glam::DVec3;

/// How many rays a bundle holds: a block of 16 x 16 pixels.
pub(super) const CAPACITY: usize = 256;

/// How many lanes work at once.
pub(super) const WIDTH: usize = F64x32::WIDTH;

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
    /// What they found.
    pub findings: [Finding; CAPACITY],
    /// The gradients at their hits, not normalised; zero where they are still to be found.
    pub gradient: [Column; 3],
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
            findings: [Finding::NOTHING; CAPACITY],
            gradient: [column; 3],
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
        self.findings[..n].fill(Finding::NOTHING);
        for axis in &mut self.gradient {
            axis[..n].fill(0.0);
        }
    }

    /// How far the farthest of the rays is still to be followed; negative where nothing is left to do.
    pub fn farthest(&self) -> f64 {
        self.limit[..self.count].iter().fold(-1.0, |a, b| a.max(*b))
    }

    /// Offers a hit to a ray, as [`Finding::offer`]. With `any`, the ray is content with it.
    pub fn offer(&mut self, ray: usize, found: Crossing, part: u32, any: bool) -> bool {
        let is_taken = self.findings[ray].offer(found, part);
        if is_taken {
            (0..3).for_each(|axis| self.gradient[axis][ray] = 0.0);
            self.limit[ray] = if any {
                -1.0
            } else {
                self.findings[ray].limit(self.t_max[ray])
            };
        }
        is_taken
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
