//! Enhanced sphere tracing: two balls in a row span a plane that both touch, and the next step is as long as that plane
//! would allow. Source: Balint and Valasek, Accelerating sphere tracing, 2018; with Ban and Valasek's code
//! `Bundas102/auto-relaxed-trace`.
//!
//! Guarantees: no root is stepped over where lambda holds on both sides of the surface: a step whose balls do not overlap
//! is taken back. Does not: a hit is only near a surface, within epsilon, and a ray that passes closer than that is called
//! a hit too.

use super::course::Course;
use super::{Ending, Segment, Walk};
use std::ops::ControlFlow;

/// A walk by enhanced steps.
pub struct Enhanced {
    course: Course,
    /// Up to here the ray is free; none before the first value.
    free: Option<f64>,
    /// Where the field is wanted.
    t: f64,
    /// The radius where the ray is free, and at the place before.
    radii: [f64; 2],
}

impl Enhanced {
    /// How much of what the plane allows is taken: of the numbers below 1 that the paper leaves open, ours.
    pub const OMEGA: f64 = 0.9;

    /// What a step from the radius `now`, after a step of `step` from the radius `before`, takes beyond `now`: the ball
    /// that touches the plane along both, times omega.
    fn beyond(step: f64, [now, before]: [f64; 2]) -> f64 {
        let rise = now - before;
        let beyond = Self::OMEGA * now * (step + rise) / (step - rise).max(f64::EPSILON * step);
        beyond.max(0.0)
    }

    fn advance(&mut self, radius: f64) -> Option<Ending> {
        let extra = match self.free {
            None => {
                self.radii = [radius, 0.0];
                self.free = Some(self.t);
                0.0
            }
            Some(before) => {
                let step = self.t - before;
                if step > self.radii[0] + radius.abs() {
                    // The balls do not overlap: back, and on by Hart's step.
                    0.0
                } else {
                    self.radii = [radius, self.radii[0]];
                    self.free = Some(self.t);
                    Self::beyond(step, self.radii)
                }
            }
        };
        let (t, radius) = (self.free.unwrap_or(self.t), self.radii[0]);
        if radius < self.course.epsilon(t) {
            return self.course.hit(t);
        }
        let end = self.course.segment.end;
        if t + radius > end {
            return self.course.miss();
        }
        self.t = (t + radius + extra).min(end);
        self.course.given_up(t, radius)
    }
}

impl Walk for Enhanced {
    const NEEDS_SLOPE: bool = false;

    fn begin(segment: Segment) -> Self {
        Self {
            course: Course::begin(segment),
            free: None,
            t: segment.start,
            radii: [0.0; 2],
        }
    }

    fn t(&self) -> f64 {
        self.t
    }

    fn observe(&mut self, value: f64, _: f64) -> Option<Ending> {
        match self.course.look(&mut self.t, value) {
            ControlFlow::Continue(radius) => self.advance(radius),
            ControlFlow::Break(ending) => ending,
        }
    }
}
