//! Sphere tracing that ends in a change of sign.
//!
//! Steps are Hart's, |f| / lambda, but never shorter than the tolerance: near a surface the ray walks on by that much
//! until the field changes its sign, and the root is then enclosed to rounding. So silhouettes do not grow by epsilon, a
//! ray that starts on a surface leaves it, and a touch from outside is no hit. A root is passed over only together with
//! a second one closer to it along the ray than the tolerance. A field that changes faster than lambda allows
//! refutes its constant, and the walk ends as unknown. Source: Hart 1996; bracketing after Dowell and Jarratt 1971.

use super::{Ending, Segment, Walk};
use crate::trace::Verdict;

/// A sample of the field along the ray.
#[derive(Clone, Copy, Debug)]
struct Sample {
    t: f64,
    value: f64,
}

/// What the walk is doing.
#[derive(Clone, Copy, Debug)]
enum Phase {
    /// Stepping forward; the last sample that was not zero, if there is one.
    Marching(Option<Sample>),
    /// Narrowing a change of sign between two samples.
    Enclosing(Sample, Sample),
}

/// A walk by certified sphere tracing.
pub struct Certified {
    segment: Segment,
    phase: Phase,
    t: f64,
    steps: u32,
    /// Whether a sheet that the ray may have started on lies behind it.
    has_departed: bool,
    /// Evaluations spent on enclosing.
    narrowings: u32,
    noise: f64,
}

impl Certified {
    /// More narrowings than halving needs from any width to rounding.
    const MAX_NARROWINGS: u32 = 200;

    fn end(&self, verdict: Verdict, t: f64, error: f64) -> Option<Ending> {
        Some(Ending {
            verdict,
            t,
            error,
            steps: self.steps,
        })
    }

    fn march(&mut self, now: Sample, last: Option<Sample>) -> Option<Ending> {
        let segment = self.segment;
        self.steps += 1;
        if let Some(last) = last {
            let allowed = segment.lipschitz * (now.t - last.t) * (1.0 + 1e-9) + self.noise;
            if (now.value - last.value).abs() > allowed {
                return self.end(Verdict::Unknown, last.t, f64::INFINITY);
            }
            if now.value != 0.0 && (now.value < 0.0) != (last.value < 0.0) {
                self.phase = Phase::Enclosing(last, now);
                return self.narrow();
            }
        }
        let epsilon = segment
            .epsilon(now.t)
            .max(4.0 * f64::EPSILON * segment.size.max(now.t));
        let free = now.value.abs() / segment.lipschitz;
        if segment.is_sheet {
            if free <= epsilon && self.has_departed {
                return self.end(Verdict::Hit, now.t, epsilon);
            }
            self.has_departed |= free > epsilon;
        }
        if now.t >= segment.end {
            return self.end(Verdict::Miss, segment.end, 0.0);
        }
        if self.steps >= segment.max_steps {
            return self.end(Verdict::Unknown, now.t, f64::INFINITY);
        }
        // A zero is a touch until the sign behind it is known; and so is what the ray starts on.
        let is_on_surface = now.value == 0.0 || (now.t == 0.0 && now.value.abs() <= self.noise);
        self.phase = Phase::Marching(if is_on_surface { last } else { Some(now) });
        if now.t + free > segment.end {
            return self.end(Verdict::Miss, segment.end, 0.0);
        }
        // A step longer than is known to be free must not jump over the end of the segment.
        self.t = if free >= epsilon {
            now.t + free
        } else {
            (now.t + epsilon).min(segment.end)
        };
        None
    }

    /// The next place inside the enclosure, or the end if it is as narrow as rounding allows.
    fn narrow(&mut self) -> Option<Ending> {
        let Phase::Enclosing(low, high) = self.phase else {
            return None;
        };
        let width = high.t - low.t;
        let finest = 4.0 * f64::EPSILON * self.segment.size.max(high.t);
        if high.value == 0.0 || width <= finest || self.narrowings >= Self::MAX_NARROWINGS {
            let t = if high.value == 0.0 {
                high.t
            } else {
                low.t + 0.5 * width
            };
            return self.end(Verdict::Hit, t, width.max(finest));
        }
        self.narrowings += 1;
        // The secant's root, kept off the ends; every third time the middle, so that the width surely halves.
        let secant = low.t - low.value * width / (high.value - low.value);
        let margin = (0.01 * width).max(0.5 * finest).min(0.25 * width);
        let inner = if self.narrowings.is_multiple_of(3) || !secant.is_finite() {
            low.t + 0.5 * width
        } else {
            secant
        };
        self.t = inner.clamp(low.t + margin, high.t - margin);
        None
    }
}

impl Walk for Certified {
    const NEEDS_SLOPE: bool = false;

    fn begin(segment: Segment) -> Self {
        Self {
            segment,
            phase: Phase::Marching(None),
            t: segment.start,
            steps: 0,
            has_departed: segment.start > 0.0,
            narrowings: 0,
            noise: segment.noise(),
        }
    }

    fn t(&self) -> f64 {
        self.t
    }

    fn observe(&mut self, value: f64, _: f64) -> Option<Ending> {
        if value.is_nan() {
            return self.end(Verdict::Unknown, self.t, f64::INFINITY);
        }
        let now = Sample { t: self.t, value };
        match self.phase {
            Phase::Marching(last) => self.march(now, last),
            Phase::Enclosing(low, high) => {
                let is_low = value != 0.0 && (value < 0.0) == (low.value < 0.0);
                self.phase = if is_low {
                    Phase::Enclosing(now, high)
                } else {
                    Phase::Enclosing(low, now)
                };
                self.narrow()
            }
        }
    }
}
