//! The plain minimum.

use crate::catalogue::{Blend, declaration::entry};
use crate::num::Number;

entry! {
    /// The plain minimum: edges stay sharp.
    Hard = "hard" {}
    source "Ricci 1973; Lipschitz rule: the larger constant of the two"
    example "union(sphere(1), box(1.5), blend: hard())"
}

impl Blend for Hard {
    #[inline(always)]
    fn union<N: Number>(&self, a: N, b: N) -> N {
        a.min(b)
    }

    fn width(&self) -> Option<f64> {
        Some(0.0)
    }

    fn is_hard(&self) -> bool {
        true
    }
}
