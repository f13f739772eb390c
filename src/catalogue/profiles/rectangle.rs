//! The rectangle.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A rectangle around the origin of the plane, with rounded corners if wanted.
    Rectangle = "rectangle" {
        /// The full lengths of the sides along x and y, in scene units.
        size: [f64; 2], Vector2, Range::POSITIVE, default [1.0; 2];
        /// The radius of the corners, at most half the shorter side.
        round: f64, Number, Range::NOT_NEGATIVE, default 0.0;
    }
    derived {
        core: [f64; 2] = size.map(|s| 0.5 * s - round);
    }
    source "Quilez, 2D distance functions (box, rounded box); a distance, so its constant is 1"
    example "rectangle([1, 0.6], round: 0.1).extrude(0.4)"
}

impl Primitive for Rectangle {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let zero = N::splat(0.0);
        let [w, h] = self.core;
        let (u, v) = (p.x.abs() - N::splat(w), p.y.abs() - N::splat(h));
        let distance = u.max(zero).hypot(v.max(zero)) + u.max(v).min(zero) - N::splat(self.round);
        distance.with_convexity([p.x, p.y])
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let [w, h] = self.size.map(|s| 0.5 * s + level);
        Bounds::centred([w, h, f64::INFINITY])
    }

    fn traits(&self) -> Traits {
        Traits::CONVEX.planar()
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        let most = 0.5 * self.size[0].min(self.size[1]);
        if self.round <= most {
            return Ok(());
        }
        Err((
            "round",
            format!("must be at most {most}, half the shorter side"),
        ))
    }
}
