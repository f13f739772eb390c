//! Newton's method from the safe side, for convex fields.
//!
//! Along a ray a convex field is a convex function: its tangent lies below it. So from outside, the tangent's root is
//! never behind the surface, and where the slope is not negative the ray never meets it. Convergence is quadratic, and
//! a ray that leaves a surface knows so after one step. A ray that starts inside walks by certified sphere tracing.
//! Source: forward inclusion by tangents, Aydinlilar and Zanni 2023.

use super::{Certified, Ending, Segment, Walk};
use crate::trace::Verdict;

/// A walk by tangents.
pub struct Convex {
    segment: Segment,
    t: f64,
    steps: u32,
    /// The walk of a ray that started inside.
    inside: Option<Certified>,
    noise: f64,
}

impl Convex {
    fn end(&self, verdict: Verdict, t: f64, error: f64) -> Option<Ending> {
        Some(Ending {
            verdict,
            t,
            error,
            steps: self.steps,
        })
    }
}

impl Walk for Convex {
    const NEEDS_SLOPE: bool = true;

    fn begin(segment: Segment) -> Self {
        Self {
            segment,
            t: segment.start,
            steps: 0,
            inside: None,
            noise: segment.noise(),
        }
    }

    fn t(&self) -> f64 {
        self.inside.as_ref().map_or(self.t, Walk::t)
    }

    fn observe(&mut self, value: f64, slope: f64) -> Option<Ending> {
        if let Some(walk) = &mut self.inside {
            return walk.observe(value, slope);
        }
        self.steps += 1;
        if value.is_nan() || slope.is_nan() {
            return self.end(Verdict::Unknown, self.t, f64::INFINITY);
        }
        if value <= 0.0 && self.steps == 1 {
            let mut walk = Certified::begin(self.segment);
            let ending = walk.observe(value, slope);
            self.inside = Some(walk);
            return ending;
        }
        let finest = 4.0 * f64::EPSILON * self.segment.size.max(self.t);
        if value > 0.0 && slope >= 0.0 {
            return self.end(Verdict::Miss, self.segment.end, 0.0);
        }
        let step = -value / slope;
        if value <= 0.0 || step <= finest {
            let error = (self.noise / slope.abs()).max(step.abs()).max(finest);
            return self.end(
                Verdict::Hit,
                self.t,
                error.min(self.segment.epsilon(self.t).max(finest)),
            );
        }
        if self.t + step > self.segment.end {
            return self.end(Verdict::Miss, self.segment.end, 0.0);
        }
        if self.steps >= self.segment.max_steps {
            return self.end(Verdict::Unknown, self.t, f64::INFINITY);
        }
        self.t += step;
        None
    }
}
