//! What a ray has found so far.

use super::analytic::Crossing;
use super::{Occlusion, Outcome, Ray, Verdict};

/// What a ray has found while it is traced.
#[derive(Clone, Copy, Debug)]
pub(super) struct Finding {
    /// The nearest hit; infinitely far where there is none.
    pub best: Crossing,
    /// The part that it is on.
    pub part: u32,
    /// How far the ray is known to be free where a walk could not tell; else infinite.
    pub unknown: f64,
    /// Steps taken.
    pub steps: u32,
    /// Evaluations of fields.
    pub evaluations: u32,
}

/// Whether a hit is to be taken instead of the best so far, which may be infinitely far: if it is nearer; of two at the same
/// place, that on the part declared first.
#[inline(always)]
pub(super) fn is_better(found: Crossing, part: u64, best: Crossing, other: u64) -> bool {
    let less = if found.error < best.error {
        found.error
    } else {
        best.error
    };
    let margin = less + 4.0 * f64::EPSILON * best.t;
    // Where there is none yet, the margin is infinite and so is the distance.
    let is_first = best.t == f64::INFINITY;
    let is_same = (found.t - best.t).abs() <= margin;
    let is_nearer = found.t < best.t;
    if is_same & !is_first {
        part < other
    } else {
        is_nearer
    }
}

/// The verdict on a ray whose nearest hit this is and that is free up to `unknown`, with the distance and its error: a hit
/// counts only if the ray is known to be free before it.
#[inline(always)]
pub(super) fn concluded(best: Crossing, unknown: f64) -> (Verdict, f64, f64) {
    let is_hit = best.t < f64::INFINITY && unknown >= best.t;
    let is_unknown = !is_hit && unknown < f64::INFINITY;
    let verdict = if is_hit {
        Verdict::Hit
    } else if is_unknown {
        Verdict::Unknown
    } else {
        Verdict::Miss
    };
    let t = if is_hit { best.t } else { unknown };
    let error = if is_hit { best.error } else { 0.0 };
    (verdict, t, if is_unknown { f64::INFINITY } else { error })
}

/// The verdict on a ray that is content with any hit: whichever it is, it counts.
#[inline(always)]
pub(super) fn occluded(best: Crossing, unknown: f64) -> Verdict {
    let doubtful = if unknown < f64::INFINITY {
        Verdict::Unknown
    } else {
        Verdict::Miss
    };
    if best.t < f64::INFINITY {
        Verdict::Hit
    } else {
        doubtful
    }
}

impl Finding {
    /// Nothing yet.
    pub const NOTHING: Self = Self {
        best: Crossing {
            t: f64::INFINITY,
            error: 0.0,
        },
        part: 0,
        unknown: f64::INFINITY,
        steps: 0,
        evaluations: 0,
    };

    /// Whether there is a hit.
    pub fn is_hit(&self) -> bool {
        self.best.t < f64::INFINITY
    }

    /// Takes a hit if [`is_better`] says so. Gives whether it was taken.
    pub fn offer(&mut self, found: Crossing, part: u32) -> bool {
        let is_taken = is_better(found, part.into(), self.best, self.part.into());
        if is_taken {
            (self.best, self.part) = (found, part);
        }
        is_taken
    }

    /// How far a ray that ends at `t_max` is still to be followed: behind its nearest hit, nothing is of interest.
    pub fn limit(&self, t_max: f64) -> f64 {
        (self.best.t + self.best.error).min(t_max)
    }

    /// A walk could not tell; up to `free` it could.
    pub fn doubt(&mut self, free: f64) {
        self.unknown = self.unknown.min(free);
    }

    /// What `ray` finds, without the normal.
    pub fn outcome(&self, ray: &Ray) -> Outcome {
        let (verdict, t, error) = concluded(self.best, self.unknown);
        let nothing = Outcome::NOTHING;
        let is_hit = verdict == Verdict::Hit;
        Outcome {
            verdict,
            t,
            error,
            point: if is_hit { ray.at(t) } else { nothing.point },
            normal: nothing.normal,
            part: if is_hit { self.part } else { nothing.part },
            steps: self.steps,
            evaluations: self.evaluations,
        }
    }

    /// What a ray finds that is content with any hit.
    pub fn occlusion(&self) -> Occlusion {
        Occlusion {
            verdict: occluded(self.best, self.unknown),
            steps: self.steps,
            evaluations: self.evaluations,
        }
    }
}
