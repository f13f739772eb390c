//! The round fillet.

use crate::catalogue::blend::halving_reach;
use crate::catalogue::{Blend, Range, declaration::entry};
use crate::num::Number;

entry! {
    /// Fills the seam with a fillet: exactly a quarter of a cylinder where the shapes meet at right angles.
    Fillet = "round" {
        /// The radius of the fillet, in scene units.
        k: f64, Number, Range::NOT_NEGATIVE;
    }
    source "hg_sdf, fOpUnionRound; Quilez, smooth minimum (circular geometrical); Lipschitz rule: the partial derivatives are a unit vector"
    example "union(cylinder(0.5, 2), box([2, 0.4, 2]), blend: round(0.4))"
}

impl Blend for Fillet {
    const RULE: &'static str = "sqrt(a^2 + b^2) for constants a and b, attained where the gradients are parallel: the \
         partial derivatives are the components of a unit vector";

    #[inline(always)]
    fn union<N: Number>(&self, a: N, b: N) -> N {
        let (k, zero) = (N::splat(self.k), N::splat(0.0));
        k.max(a.min(b)) - (k - a).max(zero).hypot((k - b).max(zero))
    }

    fn lipschitz(&self, a: f64, b: f64) -> f64 {
        a.hypot(b)
    }

    fn reach(&self, level: f64, n: usize) -> f64 {
        // The smaller is largest where the two are equal: k - (k - level) / sqrt 2.
        halving_reach(level, n, self.k)
    }

    fn is_hard(&self) -> bool {
        self.k == 0.0
    }
}
