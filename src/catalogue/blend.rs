//! Blends: how several fields become one.
//!
//! Most soften or shape the seam of a set operation. They are given as the union of two fields; intersection and
//! difference follow from it by signs. The others are operations of their own, as `morph(a, b, 0.5)`.

use super::{AnyBlend, Bounds, Hard, with_blend};
use crate::num::Number;

/// How scripts use a blend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manner {
    /// As the seam of a set operation: `union(a, b, ..., blend: smooth(0.1))`.
    Seam,
    /// As an operation of exactly two shapes: `morph(a, b, 0.5)`.
    Pair,
    /// As an operation of any number of shapes: `xor(a, b, ...)`.
    Several,
}

/// The mathematics of a blend.
pub trait Blend: super::Declared {
    /// How scripts use it.
    const MANNER: Manner = Manner::Seam;

    /// The Lipschitz rule in words, with its source.
    const RULE: &'static str = "the larger constant of the two: the partial derivatives are not negative and sum to 1 \
         (Hart 1996, section 3)";

    /// Whether the second shape only says where the first one changes, so that new faces show the first one's material
    /// where the second is not painted.
    const IS_TOOL: bool = false;

    /// The field of two fields. For a seam it is their union: at most the smaller of them, and monotone in both.
    fn union<N: Number>(&self, a: N, b: N) -> N;

    /// A Lipschitz constant of [`Blend::union`] of two fields with these constants: the supremum of the sum of the
    /// partial derivatives, without their signs, each times its constant.
    fn lipschitz(&self, a: f64, b: f64) -> f64 {
        a.max(b)
    }

    /// For a seam: where `n` fields, folded from first to last, are at most `level >= 0`, the smallest of them is at most
    /// this.
    fn reach(&self, level: f64, _n: usize) -> f64 {
        level
    }

    /// A box that holds every point where `n` fields, folded from first to last, are at most `level >= 0`, from the
    /// same question about each, by number.
    fn sublevel(&self, n: usize, level: f64, child: &dyn Fn(usize, f64) -> Bounds) -> Bounds {
        let level = self.reach(level, n);
        (0..n).fold(Bounds::EMPTY, |b, i| b.hull(child(i, level)))
    }

    /// For a seam: where two fields differ by at least this, the union is the smaller of them, to the bit, and so
    /// are its derivatives. None where there is no such width.
    fn width(&self) -> Option<f64> {
        None
    }

    /// For a smooth minimum, a concave function `(a + b) / 2 - f(a - b)` of the fields with partial derivatives that are
    /// not negative: the largest second derivative of f. Infinite where it has none, or nothing is known.
    fn curvature(&self) -> f64 {
        f64::INFINITY
    }

    /// Whether it is the minimum itself.
    fn is_hard(&self) -> bool {
        false
    }
}

/// [`Blend::reach`] where two fields reach at most `depth` below the smaller of them, and do not blend where they differ
/// by `width` or more: a fold that lies `width` below every later field stays there, so it never gets deeper.
pub(super) fn compact_reach(level: f64, n: usize, depth: f64, width: f64) -> f64 {
    level + (depth * n.saturating_sub(1) as f64).min(width)
}

/// [`Blend::reach`] where each further field moves the level towards `limit`, closer by the factor `sqrt(1/2)`.
pub(super) fn halving_reach(level: f64, n: usize, limit: f64) -> f64 {
    let left = 0.5_f64.powf(0.5 * n.saturating_sub(1) as f64);
    level.max(limit + (level - limit) * left)
}

/// `x / k`, and 0 for `k = 0`, where what is multiplied by it is 0.
pub(super) fn over(x: f64, k: f64) -> f64 {
    if k > 0.0 { x / k } else { 0.0 }
}

impl AnyBlend {
    /// The plain minimum.
    pub const HARD: Self = Self::Hard(Hard {});

    /// The same blend, hard where it has no width.
    pub fn simplified(self) -> Self {
        if self.is_hard() { Self::HARD } else { self }
    }

    /// Where two fields differ by at least this, the blend is the smaller of them; none where there is no such width.
    pub fn width(&self) -> Option<f64> {
        with_blend!(self, blend => blend.width())
    }

    /// Whether the blend is the minimum itself.
    pub fn is_hard(&self) -> bool {
        with_blend!(self, blend => blend.is_hard())
    }

    /// How scripts use it.
    pub fn manner(&self) -> Manner {
        fn of<B: Blend>(_: &B) -> Manner {
            B::MANNER
        }
        with_blend!(self, blend => of(blend))
    }

    /// The Lipschitz rule in words, with its source.
    pub fn rule(&self) -> &'static str {
        fn of<B: Blend>(_: &B) -> &'static str {
            B::RULE
        }
        with_blend!(self, blend => of(blend))
    }

    /// Whether the second shape only says where the first one changes.
    pub fn is_tool(&self) -> bool {
        fn of<B: Blend>(_: &B) -> bool {
            B::IS_TOOL
        }
        with_blend!(self, blend => of(blend))
    }

    /// A Lipschitz constant of the blend of two fields with these constants.
    pub fn lipschitz(&self, a: f64, b: f64) -> f64 {
        with_blend!(self, blend => blend.lipschitz(a, b))
    }

    /// The name in scripts.
    pub fn name(&self) -> &'static str {
        self.declaration().name
    }
}
