//! The sphere.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A ball around the origin.
    Sphere = "sphere" {
        /// The radius, in scene units.
        radius: f64, Number, Range::POSITIVE, default 1.0;
    }
    source "|p| - r; a distance, so its constant is 1 (Hart 1996)"
    example "sphere(1)"
}

impl Primitive for Sphere {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        p.length() - N::splat(self.radius)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::centred([self.radius + level; 3])
    }

    fn traits(&self) -> Traits {
        Traits::CONVEX
    }
}
