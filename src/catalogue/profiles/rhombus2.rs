//! The rhombus in the plane.

use crate::catalogue::plane_geometry::Edge;
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A rhombus around the origin of the plane, with its corners on the axes.
    Rhombus2 = "rhombus2" {
        /// The full lengths of the diagonals along x and y, in scene units.
        size: [f64; 2], Vector2, Range::POSITIVE, default [1.0, 1.6];
    }
    derived {
        edge: Edge = Edge::new([0.5 * size[0], 0.0], [0.0, 0.5 * size[1]]);
    }
    source "Quilez, 2D distance functions (rhombus); a distance, so its constant is 1"
    example "rhombus2([1, 1.6]).extrude(0.4)"
}

impl Primitive for Rhombus2 {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        self.edge.distance(p.x.abs(), p.y.abs()).signed
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let [w, h] = self.size.map(|s| 0.5 * s + level);
        Bounds::centred([w, h, f64::INFINITY])
    }

    fn traits(&self) -> Traits {
        Traits::CONVEX.planar()
    }
}
