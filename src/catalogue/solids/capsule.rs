//! The capsule.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A round bar along the y axis with half balls as ends.
    Capsule = "capsule" {
        /// The radius, in scene units.
        radius: f64, Number, Range::POSITIVE, default 0.3;
        /// The full length along y with both ends, at least twice the radius.
        height: f64, Number, Range::POSITIVE, default 1.2;
    }
    source "Quilez, distance functions (capsule); a distance, so its constant is 1"
    example "capsule(0.3, 1.2)"
}

impl Primitive for Capsule {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let straight = N::splat(0.5 * self.height - self.radius);
        let beyond = (p.y.abs() - straight).max(N::splat(0.0));
        N::norm3(p.x, beyond, p.z) - N::splat(self.radius)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::centred([self.radius, 0.5 * self.height, self.radius]).inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits::CONVEX
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        let least = 2.0 * self.radius;
        if self.height >= least {
            return Ok(());
        }
        Err((
            "height",
            format!("must be at least {least}, twice the radius"),
        ))
    }
}
