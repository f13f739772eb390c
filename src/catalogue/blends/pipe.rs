//! A pipe along the curve where two surfaces meet.

use crate::catalogue::{Blend, Bounds, Manner, Range, declaration::entry};
use crate::num::Number;

entry! {
    /// A pipe along the curve where the surfaces of two shapes meet; of the shapes themselves nothing is left.
    Pipe = "pipe" {
        /// The radius of the pipe, in scene units: exact where the surfaces meet at right angles.
        radius: f64, Number, Range::POSITIVE, default 0.1;
    }
    source "hg_sdf, fOpPipe; Lipschitz rule: the partial derivatives are a unit vector"
    example "pipe(sphere(1), box(1.5), 0.08)"
}

impl Blend for Pipe {
    const MANNER: Manner = Manner::Pair;
    const RULE: &'static str = "sqrt(a^2 + b^2) for constants a and b, attained where the gradients are parallel: the \
         partial derivatives are the components of a unit vector";

    #[inline(always)]
    fn union<N: Number>(&self, a: N, b: N) -> N {
        a.hypot(b) - N::splat(self.radius)
    }

    fn lipschitz(&self, a: f64, b: f64) -> f64 {
        a.hypot(b)
    }

    fn sublevel(&self, _: usize, level: f64, child: &dyn Fn(usize, f64) -> Bounds) -> Bounds {
        let level = level + self.radius;
        child(0, level).intersect(child(1, level))
    }
}
