//! Segment tracing: the constant of the field along a candidate piece of the ray, not that of all of space, says how long
//! the step is: min(|f| / K, T), and the next candidate is 1.5 times as long as the step. Source: Galin, Guerin, Paris,
//! Peytavie, Segment tracing using local Lipschitz bounds, 2020, and their code `aparis69/Segment-Tracing`. They give K
//! by rules for each primitive; here it is the range of the derivative along the ray, by interval automatic
//! differentiation, so that it exists for every field.
//!
//! Guarantees: no root is stepped over, whatever the global constant, wherever the field has a derivative; across jumps
//! and undecided branches the global constant serves. Their smallest step of 1e-3, which thin sheets fall through, is
//! left out. Does not: a hit is only near a surface, where |f| / K < epsilon.

use super::course::Course;
use super::{Ending, Segment, Walk};
use crate::num::Interval;
use std::ops::ControlFlow;

/// A walk by local constants.
pub struct SegmentTracing {
    course: Course,
    t: f64,
    /// How long the next candidate is.
    reach: f64,
    /// The free radius by the global constant, where the constant ahead is being asked for.
    radius: Option<f64>,
}

impl SegmentTracing {
    /// How much longer the next candidate is than the step before.
    pub const GROWTH: f64 = 1.5;

    /// The step, given the range of the derivative over the candidate.
    fn advance(&mut self, radius: f64, slope: Interval) -> Option<Ending> {
        let lipschitz = self.course.segment.lipschitz;
        let local = slope.magnitude().min(lipschitz);
        let free = if local > 0.0 {
            radius * (lipschitz / local)
        } else {
            f64::INFINITY
        };
        if free < self.course.epsilon(self.t) {
            return self.course.hit(self.t);
        }
        let step = free.min(self.reach);
        if self.t + step > self.course.segment.end {
            return self.course.miss();
        }
        if let Some(ending) = self.course.given_up(self.t, radius) {
            return Some(ending);
        }
        self.t += step;
        self.reach = Self::GROWTH * step;
        None
    }
}

impl Walk for SegmentTracing {
    const NEEDS_SLOPE: bool = false;

    fn begin(segment: Segment) -> Self {
        Self {
            course: Course::begin(segment),
            t: segment.start,
            reach: segment.end - segment.start,
            radius: None,
        }
    }

    fn t(&self) -> f64 {
        self.t
    }

    fn reach(&self) -> Option<f64> {
        self.radius.map(|_| self.t + self.reach)
    }

    fn observe(&mut self, value: f64, _: f64) -> Option<Ending> {
        match self.course.look(&mut self.t, value) {
            ControlFlow::Continue(radius) => {
                self.radius = Some(radius);
                None
            }
            ControlFlow::Break(ending) => ending,
        }
    }

    fn survey(&mut self, _: Interval, slope: Interval) -> Option<Ending> {
        let radius = self.radius.take()?;
        self.advance(radius, slope)
    }
}
