//! Lanes that go on by themselves: those that run out of steps, meet what is not a number, start inside of a convex shape,
//! or walk along a sheet. And those that are stuck, which ask ranges once how closely they should look.

use super::along::moving;
use super::evidence::{Trail, Witness};
use super::method::{Certified, Convex, Ending, Segment, Walk, finest};
use super::packet::{Lane, Packet, Rules, patience, place_in_cell, state};
use super::part::{Marched, Slope};
use super::survey::{decided, is_told};
use super::{Footprint, Ray, Verdict};
use crate::num::Vec3;
use glam::DVec3;

/// The share of the way on before a lane that is stuck over which ranges are asked.
const NEARBY: f64 = 0.5;

impl Packet {
    /// Walks a lane to its end outside of the lanes.
    pub(super) fn single(&mut self, lane: usize, rules: &Rules, marched: &Marched) -> Ending {
        let segment = self.segment(lane, rules, marched);
        let ray = self.ray_of(lane);
        let ending = match &marched.slope {
            Some(slope) => self.single_by_tangents(lane, &ray, segment, slope),
            None => self.single_by_steps(lane, &ray, segment, marched),
        };
        let (ending, evaluations) = decided(marched, &ray, segment, ending);
        self.evaluations[lane] += i64::from(evaluations);
        if marched.is_sheet || marched.slope.is_some() {
            return ending;
        }
        self.aligned(lane, ending, marched)
    }

    /// Lets a lane that is stuck go on: where ranges say nothing it is content with less.
    pub(super) fn unstick(&mut self, lane: usize, rules: &Rules, marched: &Marched) {
        let segment = self.segment(lane, rules, marched);
        let from = self.last_t[lane];
        let gap = [from, from + NEARBY * (self.t[lane] - from)];
        let is_told = is_told(marched, &self.ray_of(lane), &segment, gap);
        self.patience[lane] = if is_told {
            patience::LONG
        } else {
            patience::COARSE
        };
        self.evaluations[lane] += 1;
        self.state[lane] = state::MARCHING;
        // The sample on the way back into the fan is no step of its own.
        self.steps[lane] -= 1;
    }

    /// A hit on the grid of the lane where the field changes its sign there, so that it is the same whichever way the ray
    /// came to it; other endings as they are.
    fn aligned(&mut self, lane: usize, ending: Ending, marched: &Marched) -> Ending {
        let (grid, t) = (self.grid[lane], ending.t);
        if ending.verdict != Verdict::Hit || !t.is_finite() {
            return ending;
        }
        let ray = self.ray_of(lane);
        let mut value = |t: f64| {
            let p = ray.at(t);
            self.evaluations[lane] += 1;
            marched.single()(&Vec3::new(p.x, p.y, p.z))
        };
        let cell = (t / grid).floor();
        // The root may lie in a cell beside, if the enclosure reaches there.
        for cell in [cell, cell - 1.0, cell + 1.0] {
            let (low, high) = (cell * grid, (cell + 1.0) * grid);
            let is_met = low <= t + ending.error && t - ending.error <= high;
            if !is_met || low < self.start[lane] || high > self.end[lane] {
                continue;
            }
            let (a, b) = (value(low), value(high));
            let changes = b == 0.0 || (a < 0.0) != (b < 0.0);
            if a != 0.0 && changes && a.is_finite() && b.is_finite() {
                let t = place_in_cell((low, a), (high, b));
                let error = grid.max(finest(self.size[lane], t));
                return Ending { t, error, ..ending };
            }
        }
        ending
    }

    /// The end of a lane whose last two samples refute the constant, which are kept.
    pub(super) fn refuted(&self, lane: usize, marched: &Marched) -> Ending {
        let ray = self.ray_of(lane);
        let sample = |t: f64| {
            let p = ray.at(t);
            (t, marched.single()(&Vec3::new(p.x, p.y, p.z)))
        };
        let samples = [self.last_t[lane], self.t[lane]].map(sample);
        marched.evidence.add(Witness::on(&ray, samples));
        Ending::broken(self.last_t[lane], self.steps[lane] as u32)
    }

    fn ray_of(&self, lane: usize) -> Ray {
        let axis = |columns: &[Lane; 3]| DVec3::from_array([0, 1, 2].map(|i| columns[i][lane]));
        Ray {
            origin: axis(&self.origin),
            direction: axis(&self.direction),
            t_max: self.end[lane],
            footprint: Footprint {
                at_origin: self.footprint[lane],
                spread: self.spread[lane],
            },
        }
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
            let field = (slope.single)(&moving(ray.at(walk.t()), ray.direction));
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
        let last = self
            .has_last(lane)
            .then_some((self.last_t[lane], self.last_value[lane]));
        let mut trail = Trail::from(last);
        let mut walk = Certified::resume(
            segment,
            last,
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
            let value = marched.single()(&Vec3::new(p.x, p.y, p.z));
            if let Some(samples) = trail.extend(&segment, (walk.t(), value)) {
                marched.evidence.add(Witness::on(ray, samples));
            }
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
            omega: 1.0,
        }
    }
}
