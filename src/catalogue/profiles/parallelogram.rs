//! The parallelogram.

use crate::catalogue::plane_geometry::{Edge, bounds_around, convex_distance, outline};
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A rectangle around the origin of the plane, sheared along x.
    Parallelogram = "parallelogram" {
        /// The full length of the lower and the upper side, and the full distance between them, in scene units.
        size: [f64; 2], Vector2, Range::POSITIVE, default [1.0, 0.8];
        /// How far the upper side lies to the right of the lower one, in scene units.
        skew: f64, Number, Range::ANY, default 0.5;
    }
    derived {
        edges: Vec<Edge> = outline(&corners(size, skew));
    }
    source "Quilez, 2D distance functions (parallelogram); a distance, so its constant is 1"
    example "parallelogram([1, 0.8], 0.5).extrude(0.4)"
}

/// Counter-clockwise from the lower left.
fn corners(size: [f64; 2], skew: f64) -> [[f64; 2]; 4] {
    let ([w, h], s) = (size.map(|side| 0.5 * side), 0.5 * skew);
    [[-w - s, -h], [w - s, -h], [w + s, h], [s - w, h]]
}

impl Primitive for Parallelogram {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        convex_distance(&self.edges, p.x, p.y)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        bounds_around(&corners(self.size, self.skew), level)
    }

    fn traits(&self) -> Traits {
        Traits {
            is_convex: true,
            is_symmetric: [self.skew == 0.0, self.skew == 0.0, true],
            ..Traits::EXACT
        }
        .planar()
    }
}
