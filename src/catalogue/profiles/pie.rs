//! The pie.

use super::arc::{direction, extremes};
use crate::catalogue::plane_geometry::{Edge, bounds_around};
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

entry! {
    /// A slice of a disc around the origin of the plane; the positive y axis halves it.
    Pie = "pie" {
        /// The radius of the disc, in scene units.
        radius: f64, Number, Range::POSITIVE, default 0.9;
        /// The angle of the slice; at most 360 degrees, the whole disc.
        angle: f64, Angle, Range::ANGLE, default FRAC_PI_2;
    }
    derived {
        cut: Edge = Edge::new(direction(0.5 * angle).map(|c| c * radius), [0.0; 2]);
    }
    source "Quilez, 2D distance functions (pie); a distance, so its constant is 1"
    example "pie(0.9, 270deg).extrude(0.3)"
}

impl Primitive for Pie {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let disc = p.x.hypot(p.y) - N::splat(self.radius);
        if self.angle >= TAU {
            return disc;
        }
        disc.max(-self.cut.signed_distance(p.x.abs(), p.y))
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let mut points = extremes(self.radius, 0.5 * self.angle);
        points.push([0.0; 2]);
        bounds_around(&points, level)
    }

    fn traits(&self) -> Traits {
        let is_disc = self.angle >= TAU;
        Traits {
            is_convex: is_disc || self.angle <= PI,
            is_symmetric: [true, is_disc, true],
            ..Traits::EXACT
        }
        .planar()
    }
}
