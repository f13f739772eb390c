//! The pyramid.

use crate::catalogue::plane_geometry::Edge;
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A pyramid along the y axis: a square base below, the apex above, the origin half way.
    Pyramid = "pyramid" {
        /// The full length of the sides of the base, along x and z, in scene units.
        base: f64, Number, Range::POSITIVE, default 1.2;
        /// The full length from base to apex, in scene units.
        height: f64, Number, Range::POSITIVE, default 1.0;
    }
    derived {
        half: f64 = 0.5 * base;
        slant: f64 = (0.5 * base).hypot(height);
        ridge: Edge = Edge::new([0.0, -(0.5 * base).hypot(height)], [0.5 * base, 0.0]);
    }
    source "one eighth of it between its mirrors: half a flank and a part of the base; a distance, so its constant is 1"
    example "pyramid(1.2, 1)"
}

impl Primitive for Pyramid {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let zero = N::splat(0.0);
        let (x, z) = (p.x.abs(), p.z.abs());
        // The flank that faces x is the nearest one; `out` runs away from the middle of its lower edge.
        let (out, side) = (x.max(z) - N::splat(self.half), x.min(z));
        let up = p.y + N::splat(0.5 * self.height);
        let (rise, run) = (
            N::splat(self.height / self.slant),
            N::splat(self.half / self.slant),
        );
        let from_flank = out * rise + up * run;
        let down = out * run - up * rise;
        // In the plane of the flank, where the apex is at (0, -slant) and the lower edge on the first axis.
        let past_ridge = self.ridge.side(side, down);
        let past_corner = (side - N::splat(self.half)).max(zero);
        let border = past_corner
            .hypot(down)
            .min(self.ridge.distance(side, down).distance);
        let beside = N::select_lt(zero, past_ridge.max(down), border, zero);
        let from_base = N::norm3(out.max(zero), up, past_corner);
        let depth = from_flank.max(-up);
        N::select_lt(zero, depth, from_flank.hypot(beside).min(from_base), depth)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::centred([self.half, 0.5 * self.height, self.half]).inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits {
            is_symmetric: [true, false, true],
            ..Traits::CONVEX
        }
    }
}
