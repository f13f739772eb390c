//! The quadratic smooth minimum.

use crate::catalogue::blend::{compact_reach, over};
use crate::catalogue::{Blend, Range, declaration::entry};
use crate::num::Number;

entry! {
    /// The quadratic smooth minimum min(a, b) - max(k - |a - b|, 0)^2 / (4k): rounds the seam where the fields
    /// differ by less than k, and changes nothing elsewhere.
    Smooth = "smooth" {
        /// The width of the blend, in scene units.
        k: f64, Number, Range::NOT_NEGATIVE;
    }
    source "Quilez, smooth minimum (normalised form); Lipschitz rule: the partial derivatives sum to 1"
    example "union(sphere(1), box(1.5), blend: smooth(0.3))"
}

impl Blend for Smooth {
    #[inline(always)]
    fn union<N: Number>(&self, a: N, b: N) -> N {
        // b - a and not a - b: at a tie min has the slope of a, and so both slopes become 1/2.
        let overlap = (N::splat(self.k) - (b - a).abs()).max(N::splat(0.0));
        a.min(b) - overlap.square() * N::splat(over(0.25, self.k))
    }

    /// The same wherever the fields differ by less than k.
    fn curvature(&self) -> f64 {
        0.5 / self.k
    }

    fn reach(&self, level: f64, n: usize) -> f64 {
        compact_reach(level, n, 0.25 * self.k, self.k)
    }

    fn width(&self) -> Option<f64> {
        Some(self.k)
    }

    fn is_hard(&self) -> bool {
        self.k == 0.0
    }
}
