//! Two-sided Lipschitz bisection: between two values a and b there is no root if a + b >= lambda times the distance; else
//! the piece is halved, down to the accuracy, where b < 0 is a hit. Source: POV-Ray's isosurfaces,
//! `source/core/shape/isosurface.cpp`, by R. Suzuki.
//!
//! Guarantees: a hit is a change of sign, known to the accuracy (epsilon). Does not: two roots inside of one last piece are
//! passed over (sheets thinner than epsilon have holes), and so is a root within five accuracies of a surface that the
//! ray starts on. POV-Ray's container is the box of the shape; where that is endless, pieces double in length.

use super::course::Course;
use super::{Ending, Segment, Walk};
use crate::trace::Verdict;

/// The field at a place, positive on the side of the surface where the ray starts.
#[derive(Clone, Copy, Debug)]
struct Sample {
    t: f64,
    value: f64,
}

/// A walk by halving.
pub struct Bisection {
    course: Course,
    t: f64,
    /// Up to here the ray is free; none before the start is known.
    left: Option<Sample>,
    /// The ends of pieces that are still open, the nearest last.
    pending: Vec<Sample>,
    sign: f64,
    far: f64,
    has_departed: bool,
}

impl Bisection {
    /// By how many accuracies a ray that starts on a surface leaves it.
    const DEPARTURE: f64 = 5.0;

    /// A value at the start of the ray below so many accuracies times lambda counts as on the surface.
    const ON_SURFACE: f64 = 4.0;

    /// The first value, or the one behind the surface that the ray starts on.
    fn depart(&mut self, value: f64) -> Option<Ending> {
        let segment = self.course.segment;
        if self.course.steps == 1 {
            self.far = segment.far(value);
        }
        let accuracy = self.course.epsilon(self.t);
        if !self.has_departed && value.abs() < Self::ON_SURFACE * segment.lipschitz * accuracy {
            self.has_departed = true;
            self.t += Self::DEPARTURE * accuracy;
            return None;
        }
        // The region holds the solid, so a ray that comes into it is outside, whatever rounding says.
        self.sign = if value < 0.0 && segment.start == 0.0 {
            -1.0
        } else {
            1.0
        };
        self.left = Some(Sample {
            t: self.t,
            value: (self.sign * value).max(0.0),
        });
        self.next()
    }

    /// The next place to look at, once the ray is free up to `left`.
    fn next(&mut self) -> Option<Ending> {
        let segment = self.course.segment;
        let mut left = self.left?;
        while let Some(right) = self.pending.last().copied() {
            let width = right.t - left.t;
            let is_last = width < self.course.epsilon(right.t);
            if is_last && right.value < 0.0 {
                return self.course.hit(right.t);
            }
            if is_last || left.value + right.value >= segment.lipschitz * width {
                left = right;
                self.pending.pop();
                continue;
            }
            self.left = Some(left);
            self.t = left.t + 0.5 * width;
            return None;
        }
        self.left = Some(left);
        if left.t >= segment.end {
            return self.course.miss();
        }
        let free = left.value / segment.lipschitz;
        if left.t > self.far {
            let verdict = segment.verdict_at_far(left.t, free);
            return Some(self.course.end(verdict, left.t, f64::INFINITY));
        }
        // The whole segment, or where it has no end a piece as long as all before, at least what is known to be free.
        let doubled = left.t + left.t.max(2.0 * free).max(self.course.epsilon(left.t));
        self.t = if segment.end.is_finite() {
            segment.end
        } else {
            doubled
        };
        None
    }
}

impl Walk for Bisection {
    const NEEDS_SLOPE: bool = false;

    fn begin(segment: Segment) -> Self {
        Self {
            course: Course::begin(segment),
            t: segment.start,
            left: None,
            pending: Vec::new(),
            sign: 1.0,
            far: f64::INFINITY,
            has_departed: segment.start > 0.0,
        }
    }

    fn t(&self) -> f64 {
        self.t
    }

    fn observe(&mut self, value: f64, _: f64) -> Option<Ending> {
        self.course.steps += 1;
        let free = self.left.map_or(self.t, |left| left.t);
        if value.is_nan() || self.course.steps > self.course.segment.max_steps {
            return Some(self.course.end(Verdict::Unknown, free, f64::INFINITY));
        }
        if self.left.is_none() {
            return self.depart(value);
        }
        self.pending.push(Sample {
            t: self.t,
            value: self.sign * value,
        });
        self.next()
    }
}
