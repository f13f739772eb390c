//! The spindle.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A circular arc turned about its chord, which lies on the y axis: a lemon with two sharp tips.
    Spindle = "spindle" {
        /// The radius at the waist, at most half the height.
        radius: f64, Number, Range::POSITIVE, default 0.4;
        /// The full length along y from tip to tip, in scene units.
        height: f64, Number, Range::POSITIVE, default 1.6;
    }
    derived {
        arc: f64 = 0.125 * height * (height / radius) + 0.5 * radius;
        centre: f64 = 0.125 * height * (height / radius) - 0.5 * radius;
    }
    source "Quilez, distance functions (vesica segment); a distance, so its constant is 1"
    example "spindle(0.4, 1.6)"
}

impl Primitive for Spindle {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let (r, y) = (p.x.hypot(p.z), p.y.abs());
        let (tip, centre) = (N::splat(0.5 * self.height), N::splat(self.centre));
        // |q| - R as (q q - R R) / (|q| + R), with what is equal taken out: the arc of a thin spindle is huge.
        let beyond = (y - tip) * (y + tip) + r * (r + centre + centre);
        let flank = beyond / ((r + centre).hypot(y) + N::splat(self.arc));
        let past_tip = (y - tip) * centre - r * tip;
        N::select_lt(N::splat(0.0), past_tip, r.hypot(y - tip), flank)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::centred([self.radius, 0.5 * self.height, self.radius]).inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits::CONVEX
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        let most = 0.5 * self.height;
        if self.radius <= most {
            return Ok(());
        }
        Err(("radius", format!("must be at most {most}, half the height")))
    }
}
