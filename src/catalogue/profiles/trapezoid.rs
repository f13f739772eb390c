//! The trapezoid.

use crate::catalogue::plane_geometry::{Edge, convex_distance, outline};
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A trapezoid with equal legs around the origin of the plane.
    Trapezoid = "trapezoid" {
        /// The full length of the lower side, in scene units.
        bottom: f64, Number, Range::POSITIVE, default 1.4;
        /// The full length of the upper side, in scene units.
        top: f64, Number, Range::POSITIVE, default 0.7;
        /// The full distance between them, along y.
        height: f64, Number, Range::POSITIVE, default 0.9;
    }
    derived {
        edges: Vec<Edge> = outline(&[
            [-0.5 * bottom, -0.5 * height],
            [0.5 * bottom, -0.5 * height],
            [0.5 * top, 0.5 * height],
            [-0.5 * top, 0.5 * height],
        ]);
    }
    source "Quilez, 2D distance functions (isosceles trapezoid); a distance, so its constant is 1"
    example "trapezoid(1.4, 0.7, 0.9).extrude(0.4)"
}

impl Primitive for Trapezoid {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        // The half at positive x is nearest: the left leg is not asked.
        convex_distance(&self.edges[..3], p.x.abs(), p.y)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let half = 0.5 * self.bottom.max(self.top) + level;
        Bounds::centred([half, 0.5 * self.height + level, f64::INFINITY])
    }

    fn traits(&self) -> Traits {
        Traits {
            is_convex: true,
            is_symmetric: [true, self.bottom == self.top, true],
            ..Traits::EXACT
        }
        .planar()
    }
}
