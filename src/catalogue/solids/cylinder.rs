//! The cylinder.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A round bar along the y axis with flat ends.
    Cylinder = "cylinder" {
        /// The radius, in scene units.
        radius: f64, Number, Range::POSITIVE, default 0.5;
        /// The full length along y, in scene units.
        height: f64, Number, Range::POSITIVE, default 1.0;
    }
    source "Quilez, distance functions (capped cylinder); a distance, so its constant is 1"
    example "cylinder(0.5, 1)"
}

impl Primitive for Cylinder {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let zero = N::splat(0.0);
        let side = p.x.hypot(p.z) - N::splat(self.radius);
        let cap = p.y.abs() - N::splat(0.5 * self.height);
        side.max(zero).hypot(cap.max(zero)) + side.max(cap).min(zero)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::centred([self.radius, 0.5 * self.height, self.radius]).inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits::CONVEX
    }
}
