//! The symmetric difference.

use crate::catalogue::{Blend, Manner, declaration::entry};
use crate::num::Number;

entry! {
    /// What is in one of two shapes but not in both; of several, what is in an odd number of them.
    Xor = "xor" {}
    source "max(min(a, b), -max(a, b)), Quilez, distance functions (xor); Lipschitz rule: the largest constant of the shapes"
    example "xor(sphere(1), box(1.5)) - box(2).translate([1, 1, 1])"
}

impl Blend for Xor {
    const MANNER: Manner = Manner::Several;
    const RULE: &'static str =
        "the larger constant of the two: everywhere one of the fields, or minus it";

    #[inline(always)]
    fn union<N: Number>(&self, a: N, b: N) -> N {
        a.min(b).max(-a.max(b))
    }
}
