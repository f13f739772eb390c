//! Newton's method from the safe side, for convex fields.
//!
//! Along a ray a convex field is a convex function: its tangent lies below it. So from outside, the tangent's root is
//! never behind the surface, and where the slope is not negative the ray never meets it. Convergence is quadratic, and
//! a ray that leaves a surface knows so after one step. A ray that starts inside comes back from the end of its segment,
//! where it is outside again, in the same way. Source: forward inclusion by tangents, Aydinlilar and Zanni 2023.
//!
//! Guarantees: nothing is passed over, whatever the constant, where the field is convex and its derivative right; a hit is
//! known to rounding, and a miss is a slope that does not fall, or the end of the segment. Does not: in a corner where rounding
//! hides which way the field rises, or where steps run out, the answer is unknown.

use super::{Certified, Ending, Segment, Walk};
use crate::trace::Verdict;

/// Which way the walk goes.
enum Way {
    /// From outside, towards the entry.
    Ahead,
    /// From the end of the segment, back to the exit.
    Back,
    /// By sphere tracing, where there is no end to come back from.
    Marching(Certified),
}

/// A walk by tangents.
pub struct Convex {
    segment: Segment,
    t: f64,
    steps: u32,
    way: Way,
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

    fn hit(&self, value: f64, slope: f64) -> Option<Ending> {
        let error = (self.segment.noise(self.t) / slope.abs()).max((value / slope).abs());
        let error = error
            .min(self.segment.epsilon(self.t))
            .max(self.segment.finest(self.t));
        self.end(Verdict::Hit, self.t, error)
    }

    /// A ray whose first value is not positive starts inside, or on the surface.
    fn start_inside(&mut self, value: f64, slope: f64) -> Option<Ending> {
        let leaves = value >= -self.segment.noise(self.t) && slope >= 0.0;
        if leaves && self.t == 0.0 {
            return self.end(Verdict::Miss, self.segment.end, 0.0);
        }
        if self.segment.end.is_finite() {
            (self.way, self.t) = (Way::Back, self.segment.end);
            return None;
        }
        let mut walk = Certified::begin(self.segment);
        let ending = walk.observe(value, slope);
        self.way = Way::Marching(walk);
        ending
    }

    fn ahead(&mut self, value: f64, slope: f64) -> Option<Ending> {
        if value <= 0.0 && self.steps == 1 {
            return self.start_inside(value, slope);
        }
        if value > 0.0 && slope >= 0.0 {
            return self.end(Verdict::Miss, self.segment.end, 0.0);
        }
        let step = -value / slope;
        if value <= 0.0 || step <= self.segment.finest(self.t) {
            return self.hit(value, slope);
        }
        if self.t + step > self.segment.end {
            return self.end(Verdict::Miss, self.segment.end, 0.0);
        }
        self.t += step;
        None
    }

    fn back(&mut self, value: f64, slope: f64) -> Option<Ending> {
        let is_at_end = self.t == self.segment.end;
        if is_at_end && value <= 0.0 {
            return self.end(Verdict::Miss, self.segment.end, 0.0);
        }
        let step = value / slope;
        if value <= 0.0 || step <= self.segment.finest(self.t) {
            // What the ray starts on is no hit.
            let is_start = self.t <= self.segment.start + 4.0 * self.segment.finest(self.t);
            return if is_start {
                self.end(Verdict::Miss, self.segment.end, 0.0)
            } else {
                self.hit(value, slope)
            };
        }
        // Outside, a convex function that was negative before can only rise; rounding may hide that in a corner.
        if slope.is_nan() || slope <= 0.0 {
            return self.end(Verdict::Unknown, self.segment.start, f64::INFINITY);
        }
        self.t = (self.t - step).max(self.segment.start);
        None
    }
}

impl Walk for Convex {
    const NEEDS_SLOPE: bool = true;

    fn begin(segment: Segment) -> Self {
        Self {
            segment,
            t: segment.start,
            steps: 0,
            way: Way::Ahead,
        }
    }

    fn t(&self) -> f64 {
        match &self.way {
            Way::Marching(walk) => walk.t(),
            _ => self.t,
        }
    }

    fn observe(&mut self, value: f64, slope: f64) -> Option<Ending> {
        if let Way::Marching(walk) = &mut self.way {
            return walk.observe(value, slope);
        }
        self.steps += 1;
        if value.is_nan() {
            return Some(Ending::broken(self.segment.start, self.steps));
        }
        if slope.is_nan() || self.steps > self.segment.max_steps {
            return self.end(Verdict::Unknown, self.segment.start, f64::INFINITY);
        }
        match self.way {
            Way::Ahead => self.ahead(value, slope),
            _ => self.back(value, slope),
        }
    }
}
