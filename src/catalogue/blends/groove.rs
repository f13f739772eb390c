//! A groove cut into a shape.

use crate::catalogue::{Blend, Bounds, Manner, Range, declaration::entry};
use crate::num::Number;

entry! {
    /// Cuts a groove with a flat bottom into the first shape, where the surface of the second meets it.
    Groove = "groove" {
        /// The depth of the groove, in scene units.
        depth: f64, Number, Range::NOT_NEGATIVE, default 0.1;
        /// The width of the groove, in scene units.
        width: f64, Number, Range::NOT_NEGATIVE, default 0.2;
    }
    source "hg_sdf, fOpGroove; Lipschitz rule: the larger constant of the two"
    example "groove(sphere(1), box(1.5), depth: 0.1, width: 0.12)"
}

impl Blend for Groove {
    const MANNER: Manner = Manner::Pair;
    const RULE: &'static str =
        "the larger constant of the two: every face follows one of the two fields";
    const IS_TOOL: bool = true;

    #[inline(always)]
    fn union<N: Number>(&self, a: N, b: N) -> N {
        a.max((a + N::splat(self.depth)).min(N::splat(0.5 * self.width) - b.abs()))
    }

    fn sublevel(&self, _: usize, level: f64, child: &dyn Fn(usize, f64) -> Bounds) -> Bounds {
        child(0, level)
    }
}
