//! Blends: how a union joins two fields.
//!
//! A blend is given as the union of two fields; intersection and difference follow from it by signs.

use super::{AnyBlend, Range, declaration::entry, with_blend};
use crate::num::Number;

/// The mathematics of a blend.
pub trait Blend: super::Declared {
    /// The union of two fields: at most the smaller of them, monotone in both, with partial derivatives that are not
    /// negative and sum to 1, so that its Lipschitz constant is the larger of theirs.
    fn union<N: Number>(&self, a: N, b: N) -> N;

    /// How far the union of `n` fields, folded from first to last, can lie below the smallest of them.
    fn depth(&self, n: usize) -> f64;
}

entry! {
    /// The plain minimum: edges stay sharp.
    Hard = "hard" {}
    source "Ricci 1973"
    example "union(sphere(1), box(1.5), blend: hard())"
}

impl Blend for Hard {
    #[inline(always)]
    fn union<N: Number>(&self, a: N, b: N) -> N {
        a.min(b)
    }

    fn depth(&self, _: usize) -> f64 {
        0.0
    }
}

entry! {
    /// The quadratic smooth minimum min(a, b) - max(k - |a - b|, 0)^2 / (4k): rounds the seam where the fields
    /// differ by less than k, and changes nothing elsewhere.
    Smooth = "smooth" {
        /// The width of the blend, in scene units.
        k: f64, Number, Range::NOT_NEGATIVE;
    }
    source "Quilez, smooth minimum (normalised form); Lipschitz rule: the partial derivatives sum to 1"
    example "union(sphere(1), box(1.5), blend: smooth(0.3))"
}

impl Blend for Smooth {
    #[inline(always)]
    fn union<N: Number>(&self, a: N, b: N) -> N {
        // b - a and not a - b: at a tie min has the slope of a, and so both slopes become 1/2.
        let overlap = (N::splat(self.k) - (b - a).abs()).max(N::splat(0.0));
        a.min(b) - overlap.square() * N::splat(0.25 / self.k)
    }

    fn depth(&self, n: usize) -> f64 {
        // A fold that lies k below every later field no longer blends with it, so n fields reach at most k.
        self.k * (0.25 * n.saturating_sub(1) as f64).min(1.0)
    }
}

impl AnyBlend {
    /// The plain minimum.
    pub const HARD: Self = Self::Hard(Hard {});

    /// The same blend, hard where it has no width.
    pub fn simplified(self) -> Self {
        if self.depth(2) > 0.0 {
            self
        } else {
            Self::HARD
        }
    }

    /// How far the union of `n` fields can lie below the smallest of them.
    pub fn depth(&self, n: usize) -> f64 {
        with_blend!(self, blend => blend.depth(n))
    }

    /// Whether the blend is the minimum itself.
    pub fn is_hard(&self) -> bool {
        matches!(self, Self::Hard(_))
    }

    /// The name in scripts.
    pub fn name(&self) -> &'static str {
        self.declaration().name
    }
}
