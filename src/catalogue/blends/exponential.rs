//! The exponential smooth minimum.

use crate::catalogue::blend::over;
use crate::catalogue::{Blend, Range, declaration::entry};
use crate::num::Number;
use std::f64::consts::LN_2;

entry! {
    /// The exponential smooth minimum -k log2(2^(-a/k) + 2^(-b/k)): blends everywhere, the less the more the fields
    /// differ (1 % of k at a difference of 6k), and of several shapes in any order alike.
    Exponential = "exponential" {
        /// How far the blend lies below two equal fields, in scene units.
        k: f64, Number, Range::NOT_NEGATIVE;
    }
    source "Quilez, smooth minimum (exponential), written for the difference of the fields so that nothing overflows; Lipschitz rule: the partial derivatives sum to 1"
    example "union(sphere(0.6).translate([-0.5, 0, 0]), sphere(0.6).translate([0.5, 0, 0]), blend: exponential(0.1))"
}

impl Blend for Exponential {
    #[inline(always)]
    fn union<N: Number>(&self, a: N, b: N) -> N {
        // b - a and not a - b: at a tie min has the slope of a, and so both slopes become 1/2.
        let share = (-((b - a).abs() * N::splat(over(LN_2, self.k)))).exp();
        a.min(b) - (N::splat(1.0) + share).ln() * N::splat(self.k / LN_2)
    }

    /// With the shares p and 1 - p of the two powers it is p (1 - p) ln(2) / k.
    fn curvature(&self) -> f64 {
        0.25 * LN_2 / self.k
    }

    fn reach(&self, level: f64, n: usize) -> f64 {
        // Of n equal fields; the blend is associative.
        level + self.k * (n as f64).log2()
    }

    fn is_hard(&self) -> bool {
        self.k == 0.0
    }
}
