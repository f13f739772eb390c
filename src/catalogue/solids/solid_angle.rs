//! The solid angle.

use crate::catalogue::plane_geometry::Edge;
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};
use std::f64::consts::{FRAC_PI_2, PI};

entry! {
    /// The part of a ball around the origin inside of a cone along the positive y axis.
    SolidAngle = "solid_angle" {
        /// The radius of the ball, in scene units.
        radius: f64, Number, Range::POSITIVE, default 1.0;
        /// The full angle of the cone; above `180deg` the ball has a notch, at `360deg` it is whole.
        angle: f64, Angle, Range::ANGLE, default 0.5 * PI;
    }
    derived {
        flank: Edge = Edge::new([0.0; 2], [radius * (0.5 * angle).sin(), radius * (0.5 * angle).cos()]);
    }
    source "Quilez, distance functions (solid angle); a distance, so its constant is 1"
    example "solid_angle(1, 90deg).translate([0, -0.5, 0])"
}

impl Primitive for SolidAngle {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let (zero, r) = (N::splat(0.0), p.x.hypot(p.z));
        let ball = r.hypot(p.y) - N::splat(self.radius);
        if self.angle >= 2.0 * PI {
            return ball;
        }
        let found = self.flank.distance(r, p.y);
        let side = self.flank.side(r, p.y);
        let past_end = N::select_lt(side, zero, -found.distance, found.distance);
        let cone = N::select_lt(zero, found.is_within, found.signed, past_end);
        ball.max(cone)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let half = 0.5 * self.angle;
        let r = self.radius * half.min(FRAC_PI_2).sin();
        let low = self.radius * half.min(PI).cos().min(0.0);
        Bounds::new([-r, low, -r], [r, self.radius, r]).inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits {
            is_convex: self.angle <= PI || self.angle >= 2.0 * PI,
            is_symmetric: [true, self.angle >= 2.0 * PI, true],
            ..Traits::EXACT
        }
    }
}
