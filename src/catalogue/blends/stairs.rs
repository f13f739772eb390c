//! Stairs.

use crate::catalogue::blend::compact_reach;
use crate::catalogue::{Blend, Range, declaration::entry};
use crate::num::Number;

entry! {
    /// Fills the seam with stairs, each step as wide as it is high.
    Stairs = "stairs" {
        /// How far the stairs reach along each shape, in scene units.
        k: f64, Number, Range::NOT_NEGATIVE;
        /// The number of steps, from 1 to 32.
        n: f64, Count, Range::closed(1.0, 32.0), default 3.0;
    }
    source "after hg_sdf, fOpUnionStairs (by paniq), written as a minimum over the steps; Lipschitz rule: every face of a step follows one of the two fields"
    example "union(cylinder(0.5, 2), box([2, 0.4, 2]), blend: stairs(0.4, 4))"
}

impl Blend for Stairs {
    const RULE: &'static str =
        "the larger constant of the two: every face of a step follows one of the two fields";

    #[inline(always)]
    fn union<N: Number>(&self, a: N, b: N) -> N {
        // Step i is an intersection: i steps up one shape, n + 1 - i along the other.
        let step = self.k / self.n;
        let mut stairs = a.min(b);
        for i in 1..=self.n as u32 {
            let (up, along) = (f64::from(i) * step, (self.n + 1.0 - f64::from(i)) * step);
            stairs = stairs.min((a - N::splat(up)).max(b - N::splat(along)));
        }
        stairs
    }

    fn reach(&self, level: f64, n: usize) -> f64 {
        // Where the fields are equal: half of the steps, rounded up.
        compact_reach(level, n, self.k * (0.5 * self.n).ceil() / self.n, self.k)
    }

    fn is_hard(&self) -> bool {
        self.k == 0.0
    }
}
