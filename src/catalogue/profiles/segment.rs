//! The segment.

use crate::catalogue::plane_geometry::{Edge, bounds_around};
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A straight stroke between two points of the plane, with round ends.
    Segment = "segment" {
        /// One end of its middle line.
        a: [f64; 2], Vector2, Range::ANY, default [-0.5, 0.0];
        /// The other end.
        b: [f64; 2], Vector2, Range::ANY, default [0.5, 0.0];
        /// The full width of the stroke, in scene units.
        width: f64, Number, Range::POSITIVE, default 0.2;
    }
    derived {
        edge: Edge = Edge::new(a, b);
    }
    source "Quilez, 2D distance functions (segment); a distance, so its constant is 1"
    example "segment([-0.7, -0.2], [0.7, 0.3], 0.3).extrude(0.3)"
}

impl Primitive for Segment {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        self.edge.distance(p.x, p.y).distance - N::splat(0.5 * self.width)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        bounds_around(&[self.a, self.b], 0.5 * self.width + level)
    }

    fn traits(&self) -> Traits {
        Traits {
            is_convex: true,
            ..Traits::EXACT
        }
        .planar()
    }
}
