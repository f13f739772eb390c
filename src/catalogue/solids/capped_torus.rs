//! The capped torus.

use crate::catalogue::{Bounds, Class, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};
use std::f64::consts::{FRAC_PI_2, PI};

entry! {
    /// A part of a ring around the y axis, with round ends; its middle is on the positive x axis.
    CappedTorus = "capped_torus" {
        /// The radius of the circle in the middle of the tube, in scene units.
        major: f64, Number, Range::POSITIVE, default 0.75;
        /// The radius of the tube, in scene units.
        minor: f64, Number, Range::POSITIVE, default 0.2;
        /// The full angle of the part; `360deg` closes the ring.
        angle: f64, Angle, Range::ANGLE, default 1.5 * PI;
    }
    source "Quilez, distance functions (capped torus); a distance, so its constant is 1"
    example "capped_torus(0.75, 0.2, 270deg).rotate(x: 60deg)"
}

impl Primitive for CappedTorus {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let (sine, cosine) = (0.5 * self.angle).sin_cos();
        let z = p.z.abs();
        let from_circle = (p.x.hypot(z) - N::splat(self.major)).hypot(p.y);
        let from_end = N::norm3(
            p.x - N::splat(self.major * cosine),
            p.y,
            z - N::splat(self.major * sine),
        );
        // The sine of the angle that is left to the end, times the distance from the axis.
        let left = p.x * N::splat(sine) - z * N::splat(cosine);
        let line = if self.angle < 2.0 * PI {
            N::select_lt(left, N::splat(0.0), from_end, from_circle)
        } else {
            from_circle
        };
        line - N::splat(self.minor)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let half = 0.5 * self.angle;
        let (low, side) = (
            self.major * half.min(PI).cos(),
            self.major * half.min(FRAC_PI_2).sin(),
        );
        Bounds::new([low, 0.0, -side], [self.major, 0.0, side]).inflate(self.minor + level)
    }

    fn traits(&self) -> Traits {
        // A tube wider than its ring, or than half the gap between its ends, meets itself.
        let half = 0.5 * self.angle;
        let is_open = half > FRAC_PI_2 && half < PI;
        let reach = if is_open {
            self.major * half.sin()
        } else {
            self.major
        };
        Traits {
            class: if self.minor <= reach {
                Class::Exact
            } else {
                Class::Bound
            },
            is_symmetric: [half >= PI, true, true],
            ..Traits::EXACT
        }
    }
}
