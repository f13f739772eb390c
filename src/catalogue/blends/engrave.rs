//! A V-shaped line cut into a shape.

use crate::catalogue::{Blend, Bounds, Manner, Range, declaration::entry};
use crate::num::Number;
use std::f64::consts::FRAC_1_SQRT_2;

entry! {
    /// Cuts a V-shaped line into the first shape, where the surface of the second meets it.
    Engrave = "engrave" {
        /// The depth of the line, and half of its width, in scene units.
        depth: f64, Number, Range::NOT_NEGATIVE, default 0.1;
    }
    source "hg_sdf, fOpEngrave; Lipschitz rule: the norm of each of the linear pieces"
    example "engrave(sphere(1), box(1.5), 0.08)"
}

impl Blend for Engrave {
    const MANNER: Manner = Manner::Pair;
    const RULE: &'static str = "the larger of a and (a + b) / sqrt 2 for constants a and b, attained where the gradients \
         are parallel: the sums of the partial derivatives of the linear pieces";
    const IS_TOOL: bool = true;

    #[inline(always)]
    fn union<N: Number>(&self, a: N, b: N) -> N {
        a.max((a + N::splat(self.depth) - b.abs()) * N::splat(FRAC_1_SQRT_2))
    }

    fn lipschitz(&self, a: f64, b: f64) -> f64 {
        a.max((a + b) * FRAC_1_SQRT_2)
    }

    fn sublevel(&self, _: usize, level: f64, child: &dyn Fn(usize, f64) -> Bounds) -> Bounds {
        child(0, level)
    }
}
