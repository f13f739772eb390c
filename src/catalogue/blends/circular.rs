//! The circular smooth minimum.

use crate::catalogue::blend::{compact_reach, over};
use crate::catalogue::{Blend, Range, declaration::entry};
use crate::num::Number;

entry! {
    /// The smooth minimum whose seam is an arc of a circle where the shapes meet at right angles: it
    /// lies (1 - sqrt(1/2)) k below the minimum where the fields are equal, and changes nothing where they differ by k.
    Circular = "circular" {
        /// The width of the blend, in scene units.
        k: f64, Number, Range::NOT_NEGATIVE;
    }
    source "Quilez, smooth minimum (circular); Lipschitz rule: the partial derivatives sum to 1"
    example "union(cylinder(0.5, 2), box([2, 0.4, 2]), blend: circular(0.4))"
}

impl Blend for Circular {
    #[inline(always)]
    fn union<N: Number>(&self, a: N, b: N) -> N {
        // b - a and not a - b: at a tie min has the slope of a, and so both slopes become 1/2.
        let apart = ((b - a).abs() * N::splat(over(1.0, self.k))).min(N::splat(1.0));
        let two = N::splat(2.0);
        a.min(b) - (two - apart - (two - apart.square()).sqrt()) * N::splat(0.5 * self.k)
    }

    /// By the share x = |a - b| / k it is (2 - x^2)^(-3/2) / k, largest at x = 1.
    fn curvature(&self) -> f64 {
        1.0 / self.k
    }

    fn reach(&self, level: f64, n: usize) -> f64 {
        compact_reach(level, n, (1.0 - 0.5_f64.sqrt()) * self.k, self.k)
    }

    /// With room for the rounding of the share.
    fn width(&self) -> Option<f64> {
        Some(self.k * (1.0 + 4.0 * f64::EPSILON))
    }

    fn is_hard(&self) -> bool {
        self.k == 0.0
    }
}
