//! The half-space.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// The half-space of all points whose product with the unit normal is below the offset: a floor, a wall.
    Plane = "plane" {
        /// The direction that points out of the solid; its length does not matter.
        normal: [f64; 3], Direction, Range::ANY, default [0.0, 1.0, 0.0];
        /// How far the surface lies from the origin along the normal, in scene units.
        offset: f64, Number, Range::ANY, default 0.0;
    }
    derived {
        unit: [f64; 3] = unit(normal);
    }
    source "n.p - d with |n| = 1; a distance, so its constant is 1 (Hart 1996)"
    example "plane(\"y\", 0)"
}

impl Plane {
    /// The normal, of length 1.
    pub fn unit_normal(&self) -> [f64; 3] {
        self.unit
    }
}

/// The vector with length 1; scaled first, so that neither huge nor tiny ones overflow.
fn unit([x, y, z]: [f64; 3]) -> [f64; 3] {
    let largest = x.abs().max(y.abs()).max(z.abs());
    let [x, y, z] = [x / largest, y / largest, z / largest];
    let length = (x * x + y * y + z * z).sqrt();
    [x / length, y / length, z / length]
}

impl Primitive for Plane {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        Vec3::splat(self.unit).dot(*p) - N::splat(self.offset)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let mut bounds = Bounds::EVERYWHERE;
        let normal = self.unit;
        if let Some(axis) = normal.iter().position(|c| *c == 1.0) {
            bounds.high[axis] = self.offset + level;
        }
        if let Some(axis) = normal.iter().position(|c| *c == -1.0) {
            bounds.low[axis] = -self.offset - level;
        }
        bounds
    }

    fn traits(&self) -> Traits {
        let normal = self.unit;
        Traits {
            is_symmetric: normal.map(|c| c == 0.0),
            ..Traits::CONVEX
        }
    }
}
