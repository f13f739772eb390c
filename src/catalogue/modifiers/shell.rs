//! Shell.

use crate::catalogue::{Bounds, Class, Modifier, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// Keeps a wall along the surface of a shape, and makes its inside hollow.
    Shell = "shell" {
        /// The total thickness of the wall, half of it on each side of the surface, in scene units.
        thickness: f64, Number, Range::POSITIVE;
    }
    source "|f| - t / 2 keeps the constant of f"
    example "sphere(0.9).shell(0.1) - box(2).translate([1, 1, 1])"
}

impl Modifier for Shell {
    const RULE: &'static str = "the absolute value does not steepen a slope";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        child(p).abs() - N::splat(0.5 * self.thickness)
    }

    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds {
        child(level + 0.5 * self.thickness)
    }

    fn domain(&self, region: Bounds) -> Bounds {
        region
    }

    fn lipschitz(&self, child: f64, _: Bounds) -> f64 {
        child
    }

    fn traits(&self, child: &Traits) -> Traits {
        Traits {
            class: child.class.min(Class::Bound),
            is_convex: false,
            is_sheet: false,
            ..*child
        }
    }
}
