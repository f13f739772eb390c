//! The link of a chain.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A ring around the z axis, cut in half and pulled apart along y: a link of a chain.
    Link = "link" {
        /// The length of the straight parts along y, in scene units.
        length: f64, Number, Range::NOT_NEGATIVE, default 0.5;
        /// The radius of the bends, to the middle of the bar.
        major: f64, Number, Range::POSITIVE, default 0.35;
        /// The radius of the bar.
        minor: f64, Number, Range::POSITIVE, default 0.12;
    }
    source "Quilez, distance functions (link); a distance, so its constant is 1"
    example "link(0.5, 0.35, 0.12)"
}

impl Primitive for Link {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let beyond = (p.y.abs() - N::splat(0.5 * self.length)).max(N::splat(0.0));
        let from_ring = p.x.hypot(beyond) - N::splat(self.major);
        from_ring.hypot(p.z) - N::splat(self.minor)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let reach = self.major + self.minor;
        Bounds::centred([reach, reach + 0.5 * self.length, self.minor]).inflate(level)
    }

    fn traits(&self) -> Traits {
        // As of a torus: a bar wider than its bend meets itself.
        let class = if self.minor <= self.major {
            crate::catalogue::Class::Exact
        } else {
            crate::catalogue::Class::Bound
        };
        Traits {
            class,
            is_convex: false,
            ..Traits::CONVEX
        }
    }
}
