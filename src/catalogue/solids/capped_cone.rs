//! The capped cone.

use crate::catalogue::plane_geometry::Edge;
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A cone without its tip along the y axis: flat below and above, the origin half way.
    CappedCone = "capped_cone" {
        /// The radius of the lower end, in scene units.
        bottom: f64, Number, Range::POSITIVE, default 0.6;
        /// The radius of the upper end, in scene units.
        top: f64, Number, Range::POSITIVE, default 0.3;
        /// The full length between the ends, in scene units.
        height: f64, Number, Range::POSITIVE, default 1.0;
    }
    derived {
        lower: Edge = Edge::new([0.0, -0.5 * height], [bottom, -0.5 * height]);
        flank: Edge = Edge::new([bottom, -0.5 * height], [top, 0.5 * height]);
        upper: Edge = Edge::new([top, 0.5 * height], [0.0, 0.5 * height]);
    }
    source "the trapezoid of its section, turned about y; a distance, so its constant is 1"
    example "capped_cone(0.6, 0.3, 1)"
}

impl Primitive for CappedCone {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let r = p.x.hypot(p.z);
        // Inside, the nearest of the three sides; outside, the nearest of the three edges.
        let depth = self
            .lower
            .side(r, p.y)
            .max(self.flank.side(r, p.y))
            .max(self.upper.side(r, p.y));
        let ends = self
            .lower
            .distance(r, p.y)
            .distance
            .min(self.upper.distance(r, p.y).distance);
        let outside = ends.min(self.flank.distance(r, p.y).distance);
        N::select_lt(N::splat(0.0), depth, outside, depth)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let r = self.bottom.max(self.top);
        Bounds::centred([r, 0.5 * self.height, r]).inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits {
            is_symmetric: [true, self.bottom == self.top, true],
            ..Traits::CONVEX
        }
    }
}
