//! The segment.

use crate::catalogue::plane_geometry::Edge;
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
    example "segment([-0.5, 0], [0.5, 0.3], 0.2).extrude(0.2)"
}

impl Primitive for Segment {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        self.edge.distance(p.x, p.y).distance - N::splat(0.5 * self.width)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let line = Bounds::around([self.a, self.b].map(|p| [p[0], p[1], 0.0]));
        let mut bounds = line.inflate(0.5 * self.width + level);
        (bounds.low[2], bounds.high[2]) = (f64::NEG_INFINITY, f64::INFINITY);
        bounds
    }

    fn traits(&self) -> Traits {
        Traits {
            is_convex: true,
            ..Traits::EXACT
        }
        .planar()
    }
}
