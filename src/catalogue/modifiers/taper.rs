//! Taper.

use super::sweep::{largest_stretch, swept};
use crate::catalogue::{Bounds, Class, Modifier, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// Makes a shape narrower or wider towards its top: scales it across the y axis by a factor that changes evenly with
    /// the height, and stays the same below and above.
    Taper = "taper" {
        /// The factor at the top.
        top: f64, Number, Range::POSITIVE, default 0.5;
        /// The factor at the bottom.
        bottom: f64, Number, Range::POSITIVE, default 1.0;
        /// The full height over which the factor changes, half of it above the origin, in scene units.
        height: f64, Number, Range::POSITIVE, default 1.0;
    }
    derived {
        rise: f64 = (top - bottom) / height;
        is_planar: bool = false;
    }
    source "f(x / s, y, z / s) with s linear in y; the constant is multiplied by the norm of the Jacobian with \
        a = 1 / s and b = |s'| r / s^2, r the distance from the y axis (deadsy/sdfx pull request 92)"
    example "box([1, 1.4, 1]).taper(top: 0.3, height: 1.4)"
}

impl Taper {
    /// The factor at a height.
    fn factor(&self, y: f64) -> f64 {
        let half = 0.5 * self.height;
        0.5 * (self.bottom + self.top) + self.rise * y.clamp(-half, half)
    }

    /// The factors at the lower and upper end of `region`.
    fn factors(&self, region: &Bounds) -> [f64; 2] {
        [self.factor(region.low[1]), self.factor(region.high[1])]
    }
}

impl Modifier for Taper {
    const RULE: &'static str = "times the norm of the Jacobian, largest where the region is thinned most and widest: \
         (sqrt((a + 1)^2 + b^2) + sqrt((a - 1)^2 + b^2)) / 2 with a = 1 / s, b = |s'| r / s^2";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        let half = 0.5 * self.height;
        let y = p.y.clamp(N::splat(-half), N::splat(half));
        let factor = N::splat(0.5 * (self.bottom + self.top)) + y * N::splat(self.rise);
        child(&Vec3::new(p.x / factor, p.y, p.z / factor))
    }

    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds {
        let bounds = child(level);
        swept(bounds, 1, [0.0; 2], self.factors(&bounds))
    }

    fn domain(&self, region: Bounds) -> Bounds {
        swept(region, 1, [0.0; 2], self.factors(&region).map(|s| 1.0 / s))
    }

    fn lipschitz(&self, child: f64, region: Bounds) -> f64 {
        if region.is_empty() {
            return child;
        }
        let half = 0.5 * self.height;
        let [low, high] = self.factors(&region);
        let a = 1.0 / low.min(high);
        let is_changing = self.rise != 0.0 && region.low[1] < half && region.high[1] > -half;
        if !is_changing {
            return child * a.max(1.0);
        }
        let radius = if self.is_planar {
            region.reach(0)
        } else {
            region.reach(0).hypot(region.reach(2))
        };
        child * largest_stretch(a, self.rise.abs() * radius * a * a)
    }

    fn is_regional(&self) -> bool {
        self.rise != 0.0
    }

    fn traits(&self, child: &Traits) -> Traits {
        if self.top == 1.0 && self.bottom == 1.0 {
            return *child;
        }
        let [x, y, z] = child.is_symmetric;
        let is_even = self.rise == 0.0;
        Traits {
            class: child.class.min(Class::Lipschitz),
            is_convex: child.is_convex && is_even,
            is_symmetric: [x, y && is_even, z],
            ..*child
        }
    }

    fn fit(&mut self, child: &Traits, _: &dyn Fn(f64) -> Bounds) -> Result<(), (String, String)> {
        self.is_planar = child.is_planar;
        Ok(())
    }
}
