//! The cone.

use crate::catalogue::plane_geometry::Edge;
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A cone along the y axis: the base below, the apex above, the origin half way.
    Cone = "cone" {
        /// The radius of the base, in scene units.
        radius: f64, Number, Range::POSITIVE, default 0.5;
        /// The full length from base to apex, in scene units.
        height: f64, Number, Range::POSITIVE, default 1.0;
    }
    derived {
        base: Edge = Edge::new([0.0, -0.5 * height], [radius, -0.5 * height]);
        flank: Edge = Edge::new([radius, -0.5 * height], [0.0, 0.5 * height]);
    }
    source "the triangle of its section, turned about y; a distance, so its constant is 1"
    example "cone(0.5, 1)"
}

impl Primitive for Cone {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let r = p.x.hypot(p.z);
        // Inside, the nearer of the two sides; outside, the nearer of the two edges.
        let depth = self.base.side(r, p.y).max(self.flank.side(r, p.y));
        let outside = self
            .base
            .distance(r, p.y)
            .distance
            .min(self.flank.distance(r, p.y).distance);
        N::select_lt(N::splat(0.0), depth, outside, depth)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::centred([self.radius, 0.5 * self.height, self.radius]).inflate(level)
    }

    fn traits(&self) -> Traits {
        let [x, _, z] = Traits::CONVEX.is_symmetric;
        Traits {
            is_symmetric: [x, false, z],
            ..Traits::CONVEX
        }
    }
}
