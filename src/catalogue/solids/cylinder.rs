//! The cylinder.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A round bar along the y axis with flat ends, its edges rounded if wanted.
    Cylinder = "cylinder" {
        /// The radius, in scene units.
        radius: f64, Number, Range::POSITIVE, default 0.5;
        /// The full length along y, in scene units; `infinity` makes a bar without ends.
        height: f64, Number, Range::POSITIVE_OR_INFINITE, default 1.0;
        /// The radius of the edges, at most the radius and half the height.
        round: f64, Number, Range::NOT_NEGATIVE, default 0.0;
    }
    derived {
        core: [f64; 2] = [radius - round, 0.5 * height - round];
    }
    source "Quilez, distance functions (capped and rounded cylinder); a distance, so its constant is 1"
    example "cylinder(0.6, 1, round: 0.1)"
}

impl Primitive for Cylinder {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let zero = N::splat(0.0);
        let side = p.x.hypot(p.z) - N::splat(self.core[0]);
        let cap = p.y.abs() - N::splat(self.core[1]);
        let outside = side.max(zero).hypot(cap.max(zero));
        let distance = outside + side.max(cap).min(zero) - N::splat(self.round);
        distance.with_convexity([p.x, p.y, p.z])
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::centred([self.radius, 0.5 * self.height, self.radius]).inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits::CONVEX
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        let most = self.radius.min(0.5 * self.height);
        if self.round <= most {
            return Ok(());
        }
        let which = if most < self.radius {
            "half the height"
        } else {
            "the radius"
        };
        Err(("round", format!("must be at most {most}, {which}")))
    }
}
