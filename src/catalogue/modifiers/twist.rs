//! Twist.

use crate::catalogue::{Bounds, Class, Modifier, Range, Traits, declaration::entry};
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
    /// The largest distance from the axis in `region`.
    fn radius(region: &Bounds) -> f64 {
        region.reach(0).hypot(region.reach(2))
    }
}

impl Modifier for Twist {
    const RULE: &'static str = "times s/2 + sqrt(1 + s^2/4), s = |rate| r with r the largest distance from the axis: the norm of          the Jacobian of a shear by s";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        let angle = p.y * N::splat(self.rate);
        let (s, c) = (angle.sin(), angle.cos());
        child(&Vec3::new(c * p.x - s * p.z, p.y, s * p.x + c * p.z))
    }

    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds {
        self.domain(child(level))
    }

    fn domain(&self, region: Bounds) -> Bounds {
        if region.is_empty() || self.rate == 0.0 {
            return region;
        }
        let r = Self::radius(&region);
        Bounds::new([-r, region.low[1], -r], [r, region.high[1], r])
    }

    fn lipschitz(&self, child: f64, region: Bounds) -> f64 {
        if self.rate == 0.0 {
            return child;
        }
        let s = self.rate.abs() * Self::radius(&region);
        child * (0.5 * s + (1.0 + 0.25 * s * s).sqrt())
    }

    fn is_regional(&self) -> bool {
        self.rate != 0.0
    }

    fn traits(&self, child: &Traits) -> Traits {
        if self.rate == 0.0 {
            return *child;
        }
        Traits {
            class: Class::Lipschitz.min(child.class),
            is_convex: false,
            is_symmetric: [false; 3],
            ..*child
        }
    }

    fn fit(&mut self, child: &Traits, _: &dyn Fn(f64) -> Bounds) -> Result<(), (String, String)> {
        if !child.is_planar {
            return Ok(());
        }
        Err((
            "a profile has no height to twist along".into(),
            "extrude it first".into(),
        ))
    }
}
