//! What rays find.

use glam::DVec3;

/// How certain a ray is of what it found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// There is a surface, and no other before it.
    Hit,
    /// There is none.
    Miss,
    /// The steps ran out, the field was not a number, or it was steeper than its Lipschitz constant.
    Unknown,
}

impl Verdict {
    /// The verdict in lower case.
    pub fn word(self) -> &'static str {
        match self {
            Self::Hit => "hit",
            Self::Miss => "miss",
            Self::Unknown => "unknown",
        }
    }
}

/// How many verdicts are that one.
pub fn count(verdicts: &[Verdict], verdict: Verdict) -> usize {
    // Bytes are summed many at once, as long as they can't overflow.
    let sum = |some: &[Verdict]| {
        some.iter()
            .map(|other| u8::from(*other == verdict))
            .sum::<u8>()
    };
    verdicts
        .chunks(128)
        .map(|some| usize::from(sum(some)))
        .sum()
}

/// What a ray finds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// How certain it is.
    pub verdict: Verdict,
    /// The distance along the ray, in scene units; infinite where there is no hit. Where the verdict is unknown, how far
    /// the ray is known to be free.
    pub t: f64,
    /// The surface is within `t - error` and `t + error`.
    pub error: f64,
    /// Where it hit.
    pub point: DVec3,
    /// The outward unit normal: the direction of the gradient, or the front of a triangle.
    pub normal: DVec3,
    /// The part of the world that was hit, by number; 0 where there is no hit.
    pub part: u32,
    /// How many steps were taken.
    pub steps: u32,
    /// How many times a field was evaluated.
    pub evaluations: u32,
}

impl Outcome {
    /// A miss that took nothing.
    pub const NOTHING: Self = Self {
        verdict: Verdict::Miss,
        t: f64::INFINITY,
        error: 0.0,
        point: DVec3::ZERO,
        normal: DVec3::ZERO,
        part: 0,
        steps: 0,
        evaluations: 0,
    };
}

/// What a shadow ray finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Occlusion {
    /// `Hit` where something lies between, `Miss` where nothing does.
    pub verdict: Verdict,
    /// How many steps were taken.
    pub steps: u32,
    /// How many times a field was evaluated.
    pub evaluations: u32,
}
