//! The box.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A box around the origin, with rounded edges if wanted.
    Cuboid = "box" {
        /// The full lengths of the sides along x, y and z, in scene units; a single number makes a cube.
        size: [f64; 3], Factors, Range::POSITIVE, default [1.0; 3];
        /// The radius of the edges, at most half the shortest side.
        round: f64, Number, Range::NOT_NEGATIVE, default 0.0;
    }
    derived {
        core: [f64; 3] = size.map(|s| 0.5 * s - round);
    }
    source "Quilez, distance functions (box, round box); a distance, so its constant is 1"
    example "box([1.4, 0.8, 1], round: 0.1)"
}

impl Primitive for Cuboid {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let q = p.abs() - Vec3::splat(self.core);
        let outside = q.each(|c| c.max(N::splat(0.0))).length();
        let distance = outside + q.max_component().min(N::splat(0.0)) - N::splat(self.round);
        distance.with_convexity([p.x, p.y, p.z])
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::centred(self.size.map(|s| 0.5 * s)).inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits::CONVEX
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        let most = 0.5 * self.size.into_iter().fold(f64::INFINITY, f64::min);
        if self.round <= most {
            return Ok(());
        }
        Err((
            "round",
            format!("must be at most {most}, half the shortest side"),
        ))
    }
}
