//! The torus.

use crate::catalogue::{Bounds, Class, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A ring around the y axis.
    Torus = "torus" {
        /// The radius of the circle in the middle of the tube, in scene units.
        major: f64, Number, Range::POSITIVE, default 0.75;
        /// The radius of the tube, in scene units.
        minor: f64, Number, Range::POSITIVE, default 0.25;
    }
    source "Quilez, distance functions (torus); a distance, so its constant is 1"
    example "torus(0.75, 0.25)"
}

impl Primitive for Torus {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let from_ring = p.x.hypot(p.z) - N::splat(self.major);
        from_ring.hypot(p.y) - N::splat(self.minor)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let reach = self.major + self.minor;
        Bounds::centred([reach, self.minor, reach]).inflate(level)
    }

    fn traits(&self) -> Traits {
        // A tube wider than its ring meets itself, and what lies inside of both is further from the surface than told.
        let class = if self.minor <= self.major {
            Class::Exact
        } else {
            Class::Bound
        };
        Traits {
            class,
            is_convex: false,
            ..Traits::CONVEX
        }
    }
}
