//! The disc.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A disc around the origin of the plane.
    Circle = "circle" {
        /// The radius, in scene units.
        radius: f64, Number, Range::POSITIVE, default 1.0;
    }
    source "|p| - r; a distance, so its constant is 1 (Hart 1996)"
    example "circle(0.6).extrude(0.4)"
}

impl Primitive for Circle {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        p.x.hypot(p.y) - N::splat(self.radius)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let r = self.radius + level;
        Bounds::centred([r, r, f64::INFINITY])
    }

    fn traits(&self) -> Traits {
        Traits::CONVEX.planar()
    }
}
