//! Twist.

use super::sweep::{largest_stretch, swept};
use crate::catalogue::modifier::{needs_space, warped};
use crate::catalogue::{Bounds, Modifier, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// Turns a shape about the y axis, the more the higher up.
    Twist = "twist" {
        /// The angle for each scene unit along y.
        rate: f64, Angle, Range::ANY;
    }
    source "s/2 + sqrt(1 + s^2/4) with s = |rate| r, r the largest distance from the axis: the norm of the Jacobian"
    example "box([0.6, 2, 0.6]).twist(rate: 60deg)"
}

impl Twist {
    /// A box around what becomes of `bounds`, turned by the angles of its heights times `sign`.
    fn turned(&self, bounds: Bounds, sign: f64) -> Bounds {
        if bounds.is_empty() || self.rate == 0.0 {
            return bounds;
        }
        let turns = [bounds.low[1], bounds.high[1]].map(|y| sign * self.rate * y);
        swept(bounds, 1, turns, [1.0; 2])
    }
}

impl Modifier for Twist {
    const RULE: &'static str = "times s/2 + sqrt(1 + s^2/4), s = |rate| r with r the largest distance from the axis: the norm of \
         the Jacobian of a shear by s";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        let angle = p.y * N::splat(self.rate);
        let (s, c) = angle.sin_cos();
        child(&Vec3::new(c * p.x - s * p.z, p.y, s * p.x + c * p.z))
    }

    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds {
        self.turned(child(level), 1.0)
    }

    fn domain(&self, region: Bounds) -> Bounds {
        self.turned(region, -1.0)
    }

    fn lipschitz(&self, child: f64, region: Bounds) -> f64 {
        if self.rate == 0.0 {
            return child;
        }
        let radius = region.reach(0).hypot(region.reach(2));
        child * largest_stretch(1.0, self.rate.abs() * radius)
    }

    fn is_regional(&self) -> bool {
        self.rate != 0.0
    }

    fn traits(&self, child: &Traits) -> Traits {
        if self.rate == 0.0 {
            return *child;
        }
        warped(child)
    }

    fn fit(&mut self, child: &Traits, _: &dyn Fn(f64) -> Bounds) -> Result<(), (String, String)> {
        needs_space(child, "a profile has no height to twist along")
    }
}
