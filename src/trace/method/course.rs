//! What the classical methods share: how a walk starts, and how it ends without a hit.

use super::{Ending, Segment};
use crate::trace::Verdict;
use std::ops::ControlFlow;

/// The course of a walk.
pub(super) struct Course {
    pub segment: Segment,
    pub steps: u32,
    /// The sign of the field where the ray is; none until it has left the surface that it may have started on.
    sign: Option<f64>,
    /// Beyond this, a ray through a shape without end is given up.
    far: f64,
}

impl Course {
    /// The course along a segment.
    pub fn begin(segment: Segment) -> Self {
        Self {
            segment,
            steps: 0,
            sign: None,
            far: f64::INFINITY,
        }
    }

    /// How near a surface counts as a hit at `t`: the tolerance, but not less than what rounding leaves.
    pub fn epsilon(&self, t: f64) -> f64 {
        let noise = self.segment.noise(t) / self.segment.lipschitz;
        self.segment.epsilon(t).max(noise)
    }

    /// The end of the walk at `t`.
    pub fn end(&self, verdict: Verdict, t: f64, error: f64) -> Ending {
        Ending {
            verdict,
            t,
            error,
            steps: self.steps,
        }
    }

    /// A surface near `t`.
    pub fn hit(&self, t: f64) -> Option<Ending> {
        Some(self.end(Verdict::Hit, t, self.epsilon(t)))
    }

    /// The ray is free to the end of the segment.
    pub fn miss(&self) -> Option<Ending> {
        Some(self.end(Verdict::Miss, self.segment.end, 0.0))
    }

    /// Takes the value of the field at `t`, and counts it as a step: no surface is closer than the radius that it gives, which
    /// is negative behind a surface. Breaks off with the walk's answer where it is over, or where the ray has not left the
    /// surface that it started on: then `t` moves on.
    pub fn look(&mut self, t: &mut f64, value: f64) -> ControlFlow<Option<Ending>, f64> {
        self.steps += 1;
        if self.steps == 1 {
            self.far = self.segment.far(value);
        }
        if value.is_nan() {
            return ControlFlow::Break(Some(self.end(Verdict::Unknown, *t, f64::INFINITY)));
        }
        let radius = value / self.segment.lipschitz;
        let sign = match self.sign {
            Some(sign) => sign,
            None if radius.abs() < self.epsilon(*t) && self.segment.start == 0.0 => {
                let ending = self.given_up(*t, radius);
                *t += self.epsilon(*t);
                return ControlFlow::Break(ending);
            }
            // The region holds the solid, so a ray that comes into it is outside, whatever rounding says.
            None if self.segment.start > 0.0 => 1.0,
            None => radius.signum(),
        };
        self.sign = Some(sign);
        ControlFlow::Continue(sign * radius)
    }

    /// The end of a walk that is beyond all that is known of the shape, or whose steps have run out.
    pub fn given_up(&self, t: f64, radius: f64) -> Option<Ending> {
        if t > self.segment.end {
            return self.miss();
        }
        if t > self.far {
            let verdict = self.segment.verdict_at_far(t, radius);
            return Some(self.end(verdict, t, f64::INFINITY));
        }
        let is_over = self.steps >= self.segment.max_steps;
        is_over.then(|| self.end(Verdict::Unknown, t, f64::INFINITY))
    }
}
