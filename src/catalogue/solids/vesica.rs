//! The vesica.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A lemon: a circular arc turned about its chord, which lies on the y axis, so that it has two sharp tips.
    Vesica = "vesica" {
        /// The full width at the waist, at most the height, in scene units.
        width: f64, Number, Range::POSITIVE, default 0.8;
        /// The full length along y from tip to tip, in scene units.
        height: f64, Number, Range::POSITIVE, default 1.6;
    }
    derived {
        arc: f64 = 0.25 * height * (height / width) + 0.25 * width;
        centre: f64 = 0.25 * height * (height / width) - 0.25 * width;
    }
    source "Quilez, distance functions (vesica segment); a distance, so its constant is 1"
    example "vesica(0.8, 1.6)"
}

impl Primitive for Vesica {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let (r, y) = (p.x.hypot(p.z), p.y.abs());
        let (tip, centre) = (N::splat(0.5 * self.height), N::splat(self.centre));
        // |q| - R as (q q - R R) / (|q| + R), with what is equal taken out: the arc of a thin one is huge.
        let beyond = (y - tip) * (y + tip) + r * (r + centre + centre);
        let flank = beyond / ((r + centre).hypot(y) + N::splat(self.arc));
        let past_tip = (y - tip) * centre - r * tip;
        N::select_lt(N::splat(0.0), past_tip, r.hypot(y - tip), flank)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::centred([0.5 * self.width, 0.5 * self.height, 0.5 * self.width]).inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits::CONVEX
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        if self.width <= self.height {
            return Ok(());
        }
        Err((
            "width",
            format!("must be at most {}, the height", self.height),
        ))
    }
}
