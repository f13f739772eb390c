//! A tongue that stands on a shape.

use crate::catalogue::{Blend, Bounds, Manner, Range, declaration::entry};
use crate::num::Number;

entry! {
    /// Raises a tongue with a flat top on the first shape, where the surface of the second meets it.
    Tongue = "tongue" {
        /// The height of the tongue, in scene units.
        height: f64, Number, Range::NOT_NEGATIVE, default 0.1;
        /// The width of the tongue, in scene units.
        width: f64, Number, Range::NOT_NEGATIVE, default 0.2;
    }
    source "hg_sdf, fOpTongue; Lipschitz rule: the larger constant of the two"
    example "tongue(sphere(1), box(1.5), height: 0.1, width: 0.12)"
}

impl Blend for Tongue {
    const MANNER: Manner = Manner::Pair;
    const RULE: &'static str =
        "the larger constant of the two: every face follows one of the two fields";
    const IS_TOOL: bool = true;

    #[inline(always)]
    fn union<N: Number>(&self, a: N, b: N) -> N {
        a.min((a - N::splat(self.height)).max(b.abs() - N::splat(0.5 * self.width)))
    }

    fn sublevel(&self, _: usize, level: f64, child: &dyn Fn(usize, f64) -> Bounds) -> Bounds {
        let raised = child(0, level + self.height);
        child(0, level).hull(raised.intersect(child(1, level + 0.5 * self.width)))
    }
}
