//! The mean of two fields.

use crate::catalogue::{Blend, Manner, Range, declaration::entry};
use crate::num::Number;

entry! {
    /// A shape between two: the mean of their fields.
    Morph = "morph" {
        /// How much of the second shape, from 0 (the first) to 1 (the second).
        t: f64, Number, Range::closed(0.0, 1.0), default 0.5;
    }
    source "(1 - t) a + t b; Lipschitz rule: the same mean of the constants"
    example "morph(sphere(1), box(1.5), t: 0.5)"
}

impl Blend for Morph {
    const MANNER: Manner = Manner::Pair;
    const RULE: &'static str = "(1 - t) a + t b for constants a and b, attained where the gradients are parallel: the \
         derivative of a sum";

    #[inline(always)]
    fn union<N: Number>(&self, a: N, b: N) -> N {
        a * N::splat(1.0 - self.t) + b * N::splat(self.t)
    }

    fn lipschitz(&self, a: f64, b: f64) -> f64 {
        // A shape without a share does not count, even if it has no finite constant.
        let part = |share: f64, x: f64| if share > 0.0 { share * x } else { 0.0 };
        part(1.0 - self.t, a) + part(self.t, b)
    }
    // A mean is at most a level only where one of the two is: the box of a union.
}
