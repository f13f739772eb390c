//! Methods: how one ray walks through one field.
//!
//! A method is a machine: it names the distance at which it wants the field, is told the value (and, if it asks, the
//! derivative along the ray), and either goes on or ends. The driver in `march.rs` feeds packets of machines. Some methods
//! also ask for the ranges of the field and of its derivative over a piece of the ray, or for what a probe says of it; the driver in
//! `survey.rs` feeds those, one ray at a time. To add a method: its file here, its name in `scene/settings.rs`, its demands below, and
//! its line in `World::walk`.

mod auto_relaxed;
mod bisect;
mod certified;
mod convex;
mod course;
mod demands;
mod enhanced;
mod interval;
mod pieces;
mod probe;
mod reference;
mod relaxed;
mod resolver;
mod segment;
mod sphere;

pub use auto_relaxed::AutoRelaxed;
pub use bisect::Bisection;
pub use certified::Certified;
pub use convex::Convex;
pub use demands::{Demands, Reach};
pub use enhanced::Enhanced;
pub use interval::IntervalAnalysis;
pub use probe::Probing;
pub use reference::Reference;
pub use relaxed::Relaxed;
pub use resolver::Resolver;
pub use segment::SegmentTracing;
pub use sphere::SphereTracing;

use super::probe::Ahead;
use super::{Footprint, Verdict};
use crate::num::Interval;

/// What a ray walks along: from `start` to `end`, both along the ray.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    /// Where the field begins to matter; not negative.
    pub start: f64,
    /// Where it ends; may be infinite.
    pub end: f64,
    /// The Lipschitz constant on the way.
    pub lipschitz: f64,
    /// How wide the pixel is.
    pub footprint: Footprint,
    /// The tolerance, in footprints.
    pub tolerance: f64,
    /// How many steps are allowed.
    pub max_steps: u32,
    /// The size of coordinates on the way, for rounding errors: the larger of |origin| and the region's reach.
    pub size: f64,
    /// Whether the field is never negative.
    pub is_sheet: bool,
    /// Whether the shape has no finite bounds.
    pub is_endless: bool,
    /// How much longer over-relaxed steps are than what is known to be free.
    pub omega: f64,
}

impl Segment {
    /// The tolerance at `t`, in scene units.
    pub fn epsilon(&self, t: f64) -> f64 {
        self.tolerance * self.footprint.at(t)
    }

    /// How much of a difference between two values of the field up to `t` may be rounding: coordinates are rounded to
    /// `(size + t) 2^-53`, and a tree of a few dozen operations adds about as many roundings.
    pub fn noise(&self, t: f64) -> f64 {
        64.0 * f64::EPSILON * (self.size + t) * self.lipschitz
    }

    /// The smallest difference of distances that rounding leaves at `t`.
    pub fn finest(&self, t: f64) -> f64 {
        finest(self.size, t)
    }

    /// How far a ray is followed through a shape without end, given the field where it starts: 2^30 times the size of
    /// what is known of it. Infinite for a shape with an end.
    pub fn far(&self, value: f64) -> f64 {
        if !self.is_endless {
            return f64::INFINITY;
        }
        let size = self
            .size
            .max(value.abs() / self.lipschitz)
            .max(self.footprint.at_origin);
        size * (1u64 << 30) as f64
    }

    /// What is said of a ray that was followed that far: a miss if the field has grown with the distance, so that the
    /// ray leaves everything behind; else unknown.
    pub fn verdict_at_far(&self, t: f64, free: f64) -> Verdict {
        if free * (1u64 << 20) as f64 >= t {
            Verdict::Miss
        } else {
            Verdict::Unknown
        }
    }
}

/// The smallest difference of distances that rounding leaves at `t`, where coordinates are as large as `size`. For lanes too.
#[inline(always)]
pub fn finest(size: f64, t: f64) -> f64 {
    4.0 * f64::EPSILON * if size > t { size } else { t }
}

/// How a walk ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ending {
    /// What it found.
    pub verdict: Verdict,
    /// Where: the hit, or how far the ray is known to be free.
    pub t: f64,
    /// The surface is within `t - error` and `t + error`; NaN where the field is broken.
    pub error: f64,
    /// How many steps were taken.
    pub steps: u32,
}

impl Ending {
    /// The end of a walk at `t` where the field is broken: it is not a number, or steeper than its constant. Whatever
    /// another method would find in it cannot be trusted.
    pub fn broken(t: f64, steps: u32) -> Self {
        Self {
            verdict: Verdict::Unknown,
            t,
            error: f64::NAN,
            steps,
        }
    }

    /// Whether the walk could not tell, and another method may.
    pub fn is_open(&self) -> bool {
        self.verdict == Verdict::Unknown && !self.error.is_nan()
    }
}

/// A walk of one ray.
pub trait Walk: Send {
    /// Whether it needs the derivative along the ray.
    const NEEDS_SLOPE: bool;

    /// Whether its steps rest on the Lipschitz constant, so that samples that refute the constant matter.
    const RESTS_ON_CONSTANT: bool = true;

    /// The walk at the start of its segment.
    fn begin(segment: Segment) -> Self;

    /// Where the field is wanted.
    fn t(&self) -> f64;

    /// Takes the value there and, if wanted, the derivative along the ray; gives the end, if this is it.
    fn observe(&mut self, value: f64, slope: f64) -> Option<Ending>;

    /// Where ranges are wanted instead: up to here, from [`Walk::t`] on. Only `survey.rs` asks; other drivers know values.
    fn reach(&self) -> Option<f64> {
        None
    }

    /// How far ahead lines and levels are wanted instead, from [`Walk::t`] on: finite. Only `survey.rs` asks.
    fn probe(&self) -> Option<f64> {
        None
    }

    /// Takes what the field does ahead; gives the end, if this is it.
    fn ahead(&mut self, _ahead: Ahead) -> Option<Ending> {
        None
    }

    /// Takes the ranges of the field and of its derivative along the ray, rounded outwards; gives the end, if this is it.
    fn survey(&mut self, _value: Interval, _slope: Interval) -> Option<Ending> {
        None
    }
}
