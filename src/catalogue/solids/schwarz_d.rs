//! The Schwarz D surface.

use crate::catalogue::periodic::{fits, frequency, wall};
use crate::catalogue::{Bounds, Class, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

/// The supremum of the length of the gradient of the wave, sqrt(3/2).
///
/// With u, v, w for the squares of the three sines, the square of the gradient is
/// `1 - u v w - (1 - u)(1 - v)(1 - w) + 6 m`, where m is the product of all sines and cosines. By the inequality of the
/// means the two products are together at least `2 |m|`, and `|m| <= 1/8`: so it is at most `1 + 4/8`. Attained where
/// x, y and z are an eighth of a turn.
const STEEPEST: f64 = 1.224_744_871_391_589;

/// The largest value of the wave: both products together are at most `|cos x cos y| + |sin x sin y| <= 1`.
const HIGHEST: f64 = 1.0;

entry! {
    /// An endless wall along the Schwarz D surface, whose two mazes are joined like the atoms of diamond.
    SchwarzD = "schwarz_d" {
        /// The length of a cell of diamond, in scene units; the wall itself repeats after half of it.
        cell: f64, Number, Range::POSITIVE, default 1.2;
        /// The thickness of the wall where it is thinnest, in scene units; at most 0.25 cells.
        thickness: f64, Number, Range::POSITIVE, default 0.08;
    }
    source "Schwarz 1890; |cos x cos y cos z - sin x sin y sin z| over its steepest slope sqrt(3/2), which is proved by the inequality of the means and attained on the surface"
    example "schwarz_d(1.2, 0.08) & sphere(1)"
}

impl Primitive for SchwarzD {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let q = *p * N::splat(frequency(self.cell));
        let (x, y, z) = (q.x.sin_cos(), q.y.sin_cos(), q.z.sin_cos());
        let wave = x.1 * y.1 * z.1 - x.0 * y.0 * z.0;
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
