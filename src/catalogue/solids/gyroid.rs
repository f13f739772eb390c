//! The gyroid.

use crate::catalogue::periodic::{fits, frequency, wall};
use crate::catalogue::{Bounds, Class, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

/// The supremum of the length of the gradient of the wave: every component is at most a root by Cauchy's inequality,
/// `(cos x cos y - sin x sin z)^2 <= cos^2 y + sin^2 z`, and these add up to 3; attained at the origin.
const STEEPEST: f64 = 1.732_050_807_568_877_2;

/// The largest value of the wave: `sin x cos y <= (sin^2 x + cos^2 y) / 2`, and these add up to 3/2.
const HIGHEST: f64 = 1.5;

entry! {
    /// An endless wall along the gyroid, which divides space into two mazes that mirror each other.
    Gyroid = "gyroid" {
        /// The length after which the pattern repeats along each axis, in scene units.
        cell: f64, Number, Range::POSITIVE, default 0.8;
        /// The thickness of the wall where it is thinnest, in scene units; at most 0.27 cells.
        thickness: f64, Number, Range::POSITIVE, default 0.08;
    }
    source "Schoen 1970; |sin x cos y + sin y cos z + sin z cos x| over its steepest slope sqrt(3), which is proved by Cauchy's inequality and attained on the surface"
    example "gyroid(0.8, 0.08) & sphere(1)"
}

impl Primitive for Gyroid {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let q = *p * N::splat(frequency(self.cell));
        let (x, y, z) = (q.x.sin_cos(), q.y.sin_cos(), q.z.sin_cos());
        let wave = x.0 * y.1 + y.0 * z.1 + z.0 * x.1;
        wall(wave, STEEPEST, self.cell, self.thickness)
    }

    fn sublevel(&self, _: f64) -> Bounds {
        Bounds::EVERYWHERE
    }

    fn traits(&self) -> Traits {
        Traits {
            class: Class::Bound,
            ..Traits::EXACT
        }
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        fits(self.thickness, self.cell, HIGHEST / STEEPEST)
    }
}
