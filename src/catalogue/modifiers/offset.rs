//! Offset.

use crate::catalogue::{Bounds, Modifier, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// Grows a shape by a distance, or shrinks it for a negative one.
    Offset = "offset" {
        /// How far the surface moves outwards, in scene units.
        by: f64, Number, Range::ANY;
    }
    source "f - r keeps the constant (Hart 1996)"
    example "box(0.8).offset(0.1)"
}

impl Modifier for Offset {
    const RULE: &'static str = "a constant does not change a slope";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        child(p) - N::splat(self.by)
    }

    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds {
        child((level + self.by).max(0.0))
    }

    fn domain(&self, region: Bounds) -> Bounds {
        region
    }

    fn lipschitz(&self, child: f64, _: Bounds) -> f64 {
        child
    }

    fn traits(&self, child: &Traits) -> Traits {
        let stays_exact = child.is_convex && self.by >= 0.0;
        let class = if stays_exact {
            child.class
        } else {
            child.class.min(crate::catalogue::Class::Bound)
        };
        Traits {
            class,
            is_sheet: child.is_sheet && self.by <= 0.0,
            ..*child
        }
    }
}
