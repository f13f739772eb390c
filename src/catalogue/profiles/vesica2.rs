//! The vesica in the plane.

use crate::catalogue::plane_geometry::flat_arc;
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A lens around the origin of the plane: what two equal discs have in common, with its tips on the y axis.
    Vesica2 = "vesica2" {
        /// The full width in the middle, at most the height, in scene units.
        width: f64, Number, Range::POSITIVE, default 0.8;
        /// The full length from tip to tip, in scene units.
        height: f64, Number, Range::POSITIVE, default 1.6;
    }
    derived {
        back: f64 = 0.25 * (height - width) * (height + width) / width;
    }
    source "Quilez, 2D distance functions (vesica); a distance, so its constant is 1"
    example "vesica2(0.8, 1.6).extrude(0.4)"
}

impl Primitive for Vesica2 {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let (x, y) = (p.x.abs(), p.y.abs());
        let side = flat_arc(x, y, 0.5 * self.width, self.back);
        let above = y - N::splat(0.5 * self.height);
        // Beyond the normal of the arc at the tip.
        let beyond = above * N::splat(self.back) - x * N::splat(0.5 * self.height);
        N::select_lt(N::splat(0.0), beyond, x.hypot(above), side)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let [w, h] = [self.width, self.height].map(|s| 0.5 * s + level);
        Bounds::centred([w, h, f64::INFINITY])
    }

    fn traits(&self) -> Traits {
        Traits::CONVEX.planar()
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        if self.width <= self.height {
            return Ok(());
        }
        Err((
            "width",
            format!(
                "must be at most {}, the height: the tips are at the top and the bottom",
                self.height
            ),
        ))
    }
}
