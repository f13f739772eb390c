//! Hart's sphere tracing, as published: t += |f| / lambda until |f| < epsilon or t > D. Source: Hart 1996.
//!
//! Guarantees: no root is stepped over where lambda is right. Does not: a hit is only near a surface, within epsilon,
//! and a ray that passes closer than that is called a hit too.

use super::{Ending, Segment, Walk};
use crate::trace::Verdict;

/// A walk by plain sphere tracing.
pub struct SphereTracing {
    segment: Segment,
    t: f64,
    steps: u32,
    /// Whether the ray has left the surface that it may have started on.
    has_departed: bool,
    /// Beyond this, a ray through a shape without end is given up.
    far: f64,
}

impl SphereTracing {
    fn end(&self, verdict: Verdict, error: f64) -> Option<Ending> {
        Some(Ending {
            verdict,
            t: self.t,
            error,
            steps: self.steps,
        })
    }
}

impl Walk for SphereTracing {
    const NEEDS_SLOPE: bool = false;

    fn begin(segment: Segment) -> Self {
        Self {
            segment,
            t: segment.start,
            steps: 0,
            has_departed: segment.start > 0.0,
            far: f64::INFINITY,
        }
    }

    fn t(&self) -> f64 {
        self.t
    }

    fn observe(&mut self, value: f64, _: f64) -> Option<Ending> {
        self.steps += 1;
        if self.steps == 1 {
            self.far = self.segment.far(value);
        }
        if value.is_nan() {
            return self.end(Verdict::Unknown, f64::INFINITY);
        }
        let epsilon = self
            .segment
            .epsilon(self.t)
            .max(self.segment.noise(self.t) / self.segment.lipschitz);
        let distance = value.abs() / self.segment.lipschitz;
        let is_near = distance < epsilon;
        if is_near && self.has_departed {
            return self.end(Verdict::Hit, epsilon);
        }
        // A ray that starts on a surface first gets away from it.
        self.has_departed |= !is_near;
        if self.t > self.far {
            let verdict = self.segment.verdict_at_far(self.t, distance);
            return self.end(verdict, f64::INFINITY);
        }
        if self.steps >= self.segment.max_steps {
            return self.end(Verdict::Unknown, f64::INFINITY);
        }
        self.t += if is_near { epsilon } else { distance };
        if self.t > self.segment.end {
            self.end(Verdict::Miss, 0.0)
        } else {
            None
        }
    }
}
