//! Sphere tracing that ends in a change of sign.
//!
//! Steps are Hart's, |f| / lambda, but never shorter than the tolerance: near a surface the ray walks on by that much
//! until the field changes its sign, and the root is then enclosed to rounding. So silhouettes do not grow by epsilon, a
//! ray that starts on a surface leaves it, and a touch from outside is no hit. A step longer than is known to be free
//! is doubted afterwards: between two values a and b of one sign there is no root if |a| + |b| >= lambda times the
//! distance; else it is halved until that holds, a root appears, or a budget ends: then the walk ends as unknown, and so it
//! does where a field changes faster than lambda allows, which refutes its constant. A field that is never negative is
//! followed by Hart's steps until nothing but rounding is left of it.
//!
//! Guarantees: where lambda is right, no changes of sign farther apart than rounding are passed over, and a hit is one,
//! enclosed to rounding; where two samples refute lambda, the ray is unknown. Does not: where doubts or steps run out, it stays
//! unknown, for ranges to decide.
//!
//! Sources: Hart 1996; bracketing after Dowell and Jarratt 1971; the two-sided test as in POV-Ray's isosurfaces.

use super::{Ending, Segment, Walk};
use crate::trace::Verdict;

/// A sample of the field along the ray.
#[derive(Clone, Copy, Debug)]
struct Sample {
    t: f64,
    value: f64,
}

/// What the walk is doing.
#[derive(Clone, Debug)]
enum Phase {
    /// Stepping forward; the last sample that was not zero, if there is one.
    Marching(Option<Sample>),
    /// Looking between two samples of one sign for a pair of roots.
    Doubting(Doubt),
    /// Narrowing a change of sign between two samples.
    Enclosing(Sample, Sample),
}

/// The part of a step that is not known to be free.
#[derive(Clone, Debug)]
struct Doubt {
    /// Up to here it is.
    left: Sample,
    /// Samples further on, the nearest last, the end of the step first.
    pending: Vec<Sample>,
    /// How many more samples may be taken.
    budget: u32,
}

/// A walk by certified sphere tracing.
pub struct Certified {
    segment: Segment,
    phase: Phase,
    t: f64,
    steps: u32,
    /// Whether the surface that the ray may have started on lies behind it.
    has_departed: bool,
    /// Evaluations spent on enclosing.
    narrowings: u32,
    /// Beyond this, a ray through a shape without end is given up.
    far: f64,
}

impl Certified {
    /// More narrowings than halving needs from any width to rounding.
    const MAX_NARROWINGS: u32 = 200;

    /// How many samples may be taken inside of one step: a sheet met at 10 degrees or more is found down to 2^-40 of the
    /// step.
    const MAX_DOUBTS: u32 = 256;

    fn end(&self, verdict: Verdict, t: f64, error: f64) -> Option<Ending> {
        Some(Ending {
            verdict,
            t,
            error,
            steps: self.steps,
        })
    }

    fn march(&mut self, mut now: Sample, last: Option<Sample>) -> Option<Ending> {
        let segment = self.segment;
        self.steps += 1;
        if self.steps == 1 {
            self.far = segment.far(now.value);
            // The region holds the solid, so a ray that comes into it is outside, whatever rounding says.
            if now.t > 0.0 && now.value <= 0.0 {
                now.value = f64::MIN_POSITIVE;
            }
        }
        if let Some(last) = last {
            let width = now.t - last.t;
            let allowed = segment.lipschitz * width * (1.0 + 1e-9) + segment.noise(now.t);
            if (now.value - last.value).abs() > allowed {
                return Some(Ending::broken(last.t, self.steps));
            }
            if now.value != 0.0 && (now.value < 0.0) != (last.value < 0.0) {
                self.phase = Phase::Enclosing(last, now);
                return self.narrow();
            }
            if self.has_departed && !segment.is_sheet && !self.is_free(last, now) {
                self.phase = Phase::Doubting(Doubt {
                    left: last,
                    pending: vec![now],
                    budget: Self::MAX_DOUBTS,
                });
                return self.doubt();
            }
        }
        self.advance(now, last)
    }

    /// Goes on from `now`, up to which the ray is free.
    fn advance(&mut self, now: Sample, last: Option<Sample>) -> Option<Ending> {
        let segment = self.segment;
        let epsilon = segment.epsilon(now.t).max(self.segment.finest(now.t));
        let free = now.value.abs() / segment.lipschitz;
        let rounding = (segment.noise(now.t) / segment.lipschitz).max(self.segment.finest(now.t));
        if segment.is_sheet && free <= rounding && self.has_departed {
            return self.end(Verdict::Hit, now.t, rounding);
        }
        let is_sheet_ahead = segment.is_sheet && self.has_departed;
        self.has_departed |= free > epsilon || segment.start > 0.0;
        if now.t >= segment.end || now.t + free > segment.end {
            return self.end(Verdict::Miss, segment.end, 0.0);
        }
        if now.t > self.far {
            let verdict = segment.verdict_at_far(now.t, free);
            return self.end(verdict, now.t, f64::INFINITY);
        }
        if self.steps >= segment.max_steps {
            return self.end(Verdict::Unknown, now.t, f64::INFINITY);
        }
        // A zero is a touch until the sign behind it is known; and so is what the ray starts on, up to rounding.
        let is_start = !self.has_departed && now.value.abs() <= segment.noise(now.t);
        let is_on_surface = now.value == 0.0 || is_start;
        self.phase = Phase::Marching(if is_on_surface { last } else { Some(now) });
        // A step longer than is known to be free must not jump over the end of the segment.
        self.t = if free >= epsilon || is_sheet_ahead {
            now.t + free
        } else {
            (now.t + epsilon).min(segment.end)
        };
        None
    }

    /// Whether there is surely no root between two samples of one sign.
    fn is_free(&self, left: Sample, right: Sample) -> bool {
        let width = right.t - left.t;
        left.value.abs() + right.value.abs() >= self.segment.lipschitz * width * (1.0 - 1e-9)
    }

    /// The next place inside of a doubtful step, or the way on where nothing is left to doubt.
    fn doubt(&mut self) -> Option<Ending> {
        let Phase::Doubting(mut doubt) = std::mem::replace(&mut self.phase, Phase::Marching(None))
        else {
            return None;
        };
        let step_end = doubt.pending[0];
        while let Some(right) = doubt.pending.last().copied() {
            let width = right.t - doubt.left.t;
            if self.is_free(doubt.left, right) || width <= self.segment.finest(right.t) {
                doubt.left = right;
                doubt.pending.pop();
                continue;
            }
            if doubt.budget == 0 {
                return self.end(Verdict::Unknown, doubt.left.t, f64::INFINITY);
            }
            doubt.budget -= 1;
            self.t = doubt.left.t + 0.5 * width;
            self.phase = Phase::Doubting(doubt);
            return None;
        }
        self.advance(step_end, None)
    }

    /// Takes a sample inside of a doubtful step.
    fn settle(&mut self, now: Sample, mut doubt: Doubt) -> Option<Ending> {
        if now.value != 0.0 && (now.value < 0.0) != (doubt.left.value < 0.0) {
            self.phase = Phase::Enclosing(doubt.left, now);
            return self.narrow();
        }
        doubt.pending.push(now);
        self.phase = Phase::Doubting(doubt);
        self.doubt()
    }

    /// The next place inside the enclosure, or the end if it is as narrow as rounding allows.
    fn narrow(&mut self) -> Option<Ending> {
        let Phase::Enclosing(low, high) = self.phase else {
            return None;
        };
        let width = high.t - low.t;
        let finest = self.segment.finest(high.t);
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

impl Certified {
    /// A walk that goes on from what another one knows: its last sample that was not zero, if there is one, the distance
    /// where the next one is due, and how it came there.
    pub fn resume(
        segment: Segment,
        last: Option<(f64, f64)>,
        t: f64,
        has_departed: bool,
        steps: u32,
        far: f64,
    ) -> Self {
        let last = last.map(|(t, value)| Sample { t, value });
        Self {
            phase: Phase::Marching(last),
            t,
            steps,
            has_departed,
            far,
            ..Self::begin(segment)
        }
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
            far: f64::INFINITY,
        }
    }

    fn t(&self) -> f64 {
        self.t
    }

    fn observe(&mut self, value: f64, _: f64) -> Option<Ending> {
        if value.is_nan() {
            return Some(Ending::broken(self.t, self.steps));
        }
        let now = Sample { t: self.t, value };
        match std::mem::replace(&mut self.phase, Phase::Marching(None)) {
            Phase::Marching(last) => self.march(now, last),
            Phase::Doubting(doubt) => self.settle(now, doubt),
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
