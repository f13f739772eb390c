//! The slab.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// Everything between two parallel planes across the y axis.
    Slab = "slab" {
        /// The full distance between the planes, in scene units.
        thickness: f64, Number, Range::POSITIVE, default 0.5;
    }
    source "|y| - t / 2; a distance, so its constant is 1"
    example "slab(0.5) & sphere(1)"
}

impl Primitive for Slab {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        p.y.abs() - N::splat(0.5 * self.thickness)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::centred([f64::INFINITY, 0.5 * self.thickness + level, f64::INFINITY])
    }

    fn traits(&self) -> Traits {
        Traits::CONVEX
    }
}
