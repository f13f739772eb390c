//! The arc.

use crate::catalogue::plane_geometry::bounds_around;
use crate::catalogue::{Bounds, Class, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

entry! {
    /// A stroke along part of a circle around the origin of the plane, with round ends; the positive y axis halves it.
    Arc = "arc" {
        /// The radius of the circle in the middle of the stroke, in scene units.
        radius: f64, Number, Range::POSITIVE, default 0.7;
        /// The full width of the stroke, at most twice the radius.
        width: f64, Number, Range::POSITIVE, default 0.25;
        /// The angle from end to end, seen from the origin; at most 360 degrees.
        angle: f64, Angle, Range::ANGLE, default PI;
    }
    derived {
        end: [f64; 2] = direction(0.5 * angle);
    }
    source "Quilez, 2D distance functions (arc); a distance from the middle line, so its constant is 1"
    example "arc(0.7, 0.25, 220deg).extrude(0.3)"
}

/// The unit vector at an angle clockwise from the y axis.
pub(super) fn direction(angle: f64) -> [f64; 2] {
    [angle.sin(), angle.cos()]
}

/// The points that say how far an arc of radius `r` from `-half` to `half` about the y axis reaches along the axes.
pub(super) fn extremes(r: f64, half: f64) -> Vec<[f64; 2]> {
    [0.0, half, -half, FRAC_PI_2, -FRAC_PI_2]
        .into_iter()
        .filter(|angle| angle.abs() <= half)
        .map(|angle| direction(angle).map(|c| c * r))
        .collect()
}

impl Primitive for Arc {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let [sin, cos] = self.end;
        let x = p.x.abs();
        let radius = N::splat(self.radius);
        let middle = (x.hypot(p.y) - radius).abs();
        let end = (x - N::splat(self.radius * sin)).hypot(p.y - N::splat(self.radius * cos));
        // Positive where the angle from the y axis is less than that of the end.
        let inside = p.y * N::splat(sin) - x * N::splat(cos);
        N::select_lt(inside, N::splat(0.0), end, middle) - N::splat(0.5 * self.width)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        bounds_around(
            &extremes(self.radius, 0.5 * self.angle),
            0.5 * self.width + level,
        )
    }

    fn traits(&self) -> Traits {
        // The round ends meet where the gap between them is narrower than the stroke.
        let is_closed = self.angle >= TAU;
        let gap = if self.angle <= PI {
            self.radius
        } else {
            self.radius * self.end[0]
        };
        let is_apart = is_closed || 0.5 * self.width <= gap;
        Traits {
            class: if is_apart { Class::Exact } else { Class::Bound },
            is_symmetric: [true, is_closed, true],
            ..Traits::EXACT
        }
        .planar()
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        let most = 2.0 * self.radius;
        if self.width <= most {
            return Ok(());
        }
        Err(("width", format!("must be at most {most}, twice the radius")))
    }
}
