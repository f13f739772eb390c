//! The egg.

use crate::catalogue::plane_geometry::flat_arc;
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// An egg around the origin of the plane, upright: a large circle and a small one joined by smooth arcs.
    Egg = "egg" {
        /// The radius of the lower circle, in scene units.
        bottom: f64, Number, Range::POSITIVE, default 0.6;
        /// The radius of the upper circle, less than that of the lower one.
        top: f64, Number, Range::POSITIVE, default 0.3;
        /// The full height along y, at least twice the lower radius.
        height: f64, Number, Range::POSITIVE, default 1.6;
    }
    derived {
        rise: f64 = height - bottom - top;
        back: f64 = 0.5 * ((rise / (bottom - top)) * rise + top - bottom);
    }
    source "Quilez, 2D distance functions (egg), with arcs that fit the height; a distance, so its constant is 1"
    example "egg(0.6, 0.3, 1.6).extrude(0.4)"
}

impl Primitive for Egg {
    /// Three arcs that share tangents, each nearest between the normals where they meet.
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let zero = N::splat(0.0);
        let x = p.x.abs();
        let y = p.y + N::splat(0.5 * self.height - self.bottom);
        let above = y - N::splat(self.rise);
        let lower = x.hypot(y) - N::splat(self.bottom);
        let upper = x.hypot(above) - N::splat(self.top);
        let side = flat_arc(x, y, self.bottom, self.back);
        let past = above * N::splat(self.back) - x * N::splat(self.rise);
        N::select_lt(y, zero, lower, N::select_lt(zero, past, upper, side))
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::centred([
            self.bottom + level,
            0.5 * self.height + level,
            f64::INFINITY,
        ])
    }

    fn traits(&self) -> Traits {
        Traits {
            is_symmetric: [true, false, true],
            ..Traits::CONVEX
        }
        .planar()
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        if self.top >= self.bottom {
            return Err((
                "top",
                format!("must be less than {}, the lower radius", self.bottom),
            ));
        }
        let least = 2.0 * self.bottom;
        if self.height < least {
            return Err((
                "height",
                format!("must be at least {least}, twice the lower radius"),
            ));
        }
        Ok(())
    }
}
