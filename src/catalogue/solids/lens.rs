//! The lens.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// What two equal balls on the y axis have in common: bulging on both sides, with a sharp rim.
    Lens = "lens" {
        /// The radius of the rim, in scene units.
        radius: f64, Number, Range::POSITIVE, default 0.8;
        /// The full thickness in the middle, at most twice the radius.
        thickness: f64, Number, Range::POSITIVE, default 0.5;
    }
    derived {
        ball: f64 = radius * (radius / thickness) + 0.25 * thickness;
        centre: f64 = radius * (radius / thickness) - 0.25 * thickness;
    }
    source "Quilez, distance functions (vesica), turned about its short axis; a distance, so its constant is 1"
    example "lens(0.9, 0.5).rotate(x: 60deg)"
}

impl Primitive for Lens {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let (r, y) = (p.x.hypot(p.z), p.y.abs());
        let (rim, centre) = (N::splat(self.radius), N::splat(self.centre));
        // |q| - R as (q q - R R) / (|q| + R), with what is equal taken out: the balls of a thin lens are huge.
        let beyond = (r - rim) * (r + rim) + y * (y + centre + centre);
        let face = beyond / (r.hypot(y + centre) + N::splat(self.ball));
        let past_rim = (r - rim) * centre - y * rim;
        N::select_lt(N::splat(0.0), past_rim, (r - rim).hypot(y), face)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::centred([self.radius, 0.5 * self.thickness, self.radius]).inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits::CONVEX
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        let most = 2.0 * self.radius;
        if self.thickness <= most {
            return Ok(());
        }
        Err((
            "thickness",
            format!("must be at most {most}, twice the radius"),
        ))
    }
}
