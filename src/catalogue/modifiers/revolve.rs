//! Revolution.

use super::extrude::needs_profile;
use crate::catalogue::{Bounds, Class, Modifier, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// Turns a profile about the y axis; what lies on the positive side of x is seen.
    Revolve = "revolve" {
        /// How far the profile is moved away from the axis first, in scene units.
        offset: f64, Number, Range::ANY, default 0.0;
    }
    derived {
        is_exact: bool = false;
    }
    source "Quilez, 2D to 3D (revolution); the distance from the axis has slope 1, so the constant is kept"
    example "circle(0.25).revolve(offset: 0.75)"
}

impl Modifier for Revolve {
    const RULE: &'static str = "the distance from the axis has slope 1";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        let r = p.x.hypot(p.z) - N::splat(self.offset);
        child(&Vec3::new(r, p.y, N::splat(0.0)))
    }

    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds {
        let profile = child(level);
        let r = profile.high[0] + self.offset;
        if profile.is_empty() || r < 0.0 {
            return Bounds::EMPTY;
        }
        Bounds::new([-r, profile.low[1], -r], [r, profile.high[1], r])
    }

    fn domain(&self, region: Bounds) -> Bounds {
        if region.is_empty() {
            return region;
        }
        let r = region.reach(0).hypot(region.reach(2));
        Bounds::new(
            [-self.offset, region.low[1], 0.0],
            [r - self.offset, region.high[1], 0.0],
        )
    }

    fn lipschitz(&self, child: f64, _: Bounds) -> f64 {
        child
    }

    fn traits(&self, child: &Traits) -> Traits {
        Traits {
            class: if self.is_exact {
                child.class
            } else {
                child.class.min(Class::Bound)
            },
            is_convex: child.is_convex && child.is_symmetric[0] && self.offset == 0.0,
            is_sheet: child.is_sheet,
            is_symmetric: [true, child.is_symmetric[1], true],
            is_planar: false,
        }
    }

    fn fit(
        &mut self,
        child: &Traits,
        sublevel: &dyn Fn(f64) -> Bounds,
    ) -> Result<(), (String, String)> {
        // Where the profile stays on one side of the axis, or is the same on both, the nearest point is in the
        // half-plane of p.
        let stays_beyond = sublevel(0.0).low[0] + self.offset >= 0.0;
        self.is_exact = stays_beyond || (child.is_symmetric[0] && self.offset == 0.0);
        needs_profile(child, "revolved")
    }
}
