//! The chamfer.

use crate::catalogue::blend::halving_reach;
use crate::catalogue::{Blend, Range, declaration::entry};
use crate::num::Number;
use std::f64::consts::FRAC_1_SQRT_2;

entry! {
    /// Fills the seam with a flat strip at 45 degrees: the smallest of a, b and (a + b - k) / sqrt 2.
    Chamfer = "chamfer" {
        /// How far the strip reaches along each shape, in scene units.
        k: f64, Number, Range::NOT_NEGATIVE;
    }
    source "hg_sdf, fOpUnionChamfer; Lipschitz rule: the norm of each of the three linear pieces"
    example "union(cylinder(0.5, 2), box([2, 0.4, 2]), blend: chamfer(0.3))"
}

impl Blend for Chamfer {
    const RULE: &'static str = "the largest of a, b and (a + b) / sqrt 2 for constants a and b, attained where the \
         gradients are parallel: the sums of the partial derivatives of the three linear pieces";

    #[inline(always)]
    fn union<N: Number>(&self, a: N, b: N) -> N {
        a.min(b)
            .min((a + b - N::splat(self.k)) * N::splat(FRAC_1_SQRT_2))
    }

    fn lipschitz(&self, a: f64, b: f64) -> f64 {
        a.max(b).max((a + b) * FRAC_1_SQRT_2)
    }

    fn reach(&self, level: f64, n: usize) -> f64 {
        // a + b <= k + sqrt 2 level, and the smaller is at most the mean: k/2 + level / sqrt 2.
        halving_reach(level, n, self.k / (2.0 - 2.0_f64.sqrt()))
    }

    fn is_hard(&self) -> bool {
        self.k == 0.0
    }
}
