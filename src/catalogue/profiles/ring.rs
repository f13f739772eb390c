//! The ring.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// The band between two circles around the origin of the plane.
    Ring = "ring" {
        /// The radius of the middle of the band, in scene units.
        radius: f64, Number, Range::POSITIVE, default 0.75;
        /// The full width of the band, at most twice the radius.
        width: f64, Number, Range::POSITIVE, default 0.25;
    }
    source "||p| - r| - w / 2; a distance, so its constant is 1"
    example "ring(0.75, 0.25).extrude(0.3)"
}

impl Primitive for Ring {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        (p.x.hypot(p.y) - N::splat(self.radius)).abs() - N::splat(0.5 * self.width)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let r = self.radius + 0.5 * self.width + level;
        Bounds::centred([r, r, f64::INFINITY])
    }

    fn traits(&self) -> Traits {
        Traits {
            is_convex: false,
            ..Traits::CONVEX
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
