//! The cubic smooth minimum.

use crate::catalogue::blend::{compact_reach, over};
use crate::catalogue::{Blend, Range, declaration::entry};
use crate::num::Number;

entry! {
    /// The cubic smooth minimum min(a, b) - max(k - |a - b|, 0)^3 / (6k^2): rounds the seam where the fields differ
    /// by less than k, and leaves both shapes without a jump of the curvature.
    Cubic = "cubic" {
        /// The width of the blend, in scene units.
        k: f64, Number, Range::NOT_NEGATIVE;
    }
    source "Quilez, smooth minimum (cubic polynomial); Lipschitz rule: the partial derivatives sum to 1"
    example "union(sphere(0.9), box([2, 0.5, 0.5]), blend: cubic(0.5))"
}

impl Blend for Cubic {
    #[inline(always)]
    fn union<N: Number>(&self, a: N, b: N) -> N {
        // b - a and not a - b: at a tie min has the slope of a, and so both slopes become 1/2.
        let overlap = (N::splat(self.k) - (b - a).abs()).max(N::splat(0.0));
        let share = overlap * N::splat(over(1.0, self.k));
        a.min(b) - share.square() * overlap * N::splat(1.0 / 6.0)
    }

    /// (k - |x|) / k^2, largest in the middle.
    fn curvature(&self) -> f64 {
        1.0 / self.k
    }

    fn reach(&self, level: f64, n: usize) -> f64 {
        compact_reach(level, n, self.k / 6.0, self.k)
    }

    fn width(&self) -> Option<f64> {
        Some(self.k)
    }

    fn is_hard(&self) -> bool {
        self.k == 0.0
    }
}
