//! What a ray has found so far.

use super::analytic::Crossing;
use super::{Occlusion, Outcome, Ray, Verdict};

/// What a ray has found while it is traced.
#[derive(Clone, Copy, Debug)]
pub(super) struct Finding {
    /// The nearest hit, and the part that it is on.
    pub best: Option<(Crossing, u32)>,
    /// How far the ray is known to be free where a walk could not tell; else infinite.
    pub unknown: f64,
    /// Steps taken.
    pub steps: u32,
    /// Evaluations of fields.
    pub evaluations: u32,
}

impl Finding {
    /// Nothing yet.
    pub const NOTHING: Self = Self {
        best: None,
        unknown: f64::INFINITY,
        steps: 0,
        evaluations: 0,
    };

    /// Takes a hit if it is nearer; of two at the same place, that on the part declared first. Gives whether it was taken.
    pub fn offer(&mut self, found: Crossing, part: u32) -> bool {
        let is_nearer = match self.best {
            None => true,
            Some((best, other)) => {
                let margin = found.error.min(best.error) + 4.0 * f64::EPSILON * best.t;
                if (found.t - best.t).abs() <= margin {
                    part < other
                } else {
                    found.t < best.t
                }
            }
        };
        if is_nearer {
            self.best = Some((found, part));
        }
        is_nearer
    }

    /// How far a ray that ends at `t_max` is still to be followed: behind its nearest hit, nothing is of interest.
    pub fn limit(&self, t_max: f64) -> f64 {
        self.best
            .map_or(t_max, |(best, _)| (best.t + best.error).min(t_max))
    }

    /// A walk could not tell; up to `free` it could.
    pub fn doubt(&mut self, free: f64) {
        self.unknown = self.unknown.min(free);
    }

    /// What `ray` finds, without the normal.
    pub fn outcome(&self, ray: &Ray) -> Outcome {
        let nothing = Outcome {
            steps: self.steps,
            evaluations: self.evaluations,
            ..Outcome::NOTHING
        };
        match self.best {
            // A hit counts only if the ray is known to be free before it.
            Some((best, part)) if self.unknown >= best.t => Outcome {
                verdict: Verdict::Hit,
                t: best.t,
                error: best.error,
                point: ray.at(best.t),
                part,
                ..nothing
            },
            _ if self.unknown < f64::INFINITY => Outcome {
                verdict: Verdict::Unknown,
                t: self.unknown,
                error: f64::INFINITY,
                ..nothing
            },
            _ => nothing,
        }
    }

    /// What a ray finds that is content with any hit.
    pub fn occlusion(&self) -> Occlusion {
        let verdict = match self.best {
            Some(_) => Verdict::Hit,
            None if self.unknown < f64::INFINITY => Verdict::Unknown,
            None => Verdict::Miss,
        };
        Occlusion {
            verdict,
            steps: self.steps,
            evaluations: self.evaluations,
        }
    }
}
