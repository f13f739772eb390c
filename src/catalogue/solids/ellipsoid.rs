//! The ellipsoid.

use crate::catalogue::{Bounds, Class, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A ball stretched along the axes.
    Ellipsoid = "ellipsoid" {
        /// The semi-axes along x, y and z, in scene units.
        radii: [f64; 3], Vector3, Range::POSITIVE, default [1.0, 0.6, 0.8];
    }
    derived {
        inverse: [f64; 3] = radii.map(|r| 1.0 / r);
        smallest: f64 = radii.into_iter().fold(f64::INFINITY, f64::min);
    }
    source "(|p / r| - 1) min(r): the gauge of a convex body, whose slope is at most 1 / min(r)"
    example "ellipsoid([1, 0.6, 0.8])"
}

impl Primitive for Ellipsoid {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let gauge = p.times(Vec3::splat(self.inverse)).length();
        (gauge - N::splat(1.0)) * N::splat(self.smallest)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let gauge = 1.0 + level / self.smallest;
        Bounds::centred(self.radii.map(|r| r * gauge))
    }

    fn traits(&self) -> Traits {
        let is_round = self.radii.iter().all(|r| *r == self.radii[0]);
        Traits {
            class: if is_round { Class::Exact } else { Class::Bound },
            ..Traits::CONVEX
        }
    }
}
