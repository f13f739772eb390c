//! The Schwarz P surface.

use crate::catalogue::periodic::{fits, frequency, wall};
use crate::catalogue::{Bounds, Class, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

/// The supremum of the length of the gradient of the wave, whose components are sines; attained where all are 1.
const STEEPEST: f64 = 1.732_050_807_568_877_2;

/// The largest value of the wave.
const HIGHEST: f64 = 3.0;

entry! {
    /// An endless wall along the Schwarz P surface: rooms on a cubic grid, joined by round doors along the axes.
    SchwarzP = "schwarz_p" {
        /// The length after which the pattern repeats along each axis, in scene units.
        cell: f64, Number, Range::POSITIVE, default 0.8;
        /// The thickness of the wall where it is thinnest, in scene units; at most 0.55 cells.
        thickness: f64, Number, Range::POSITIVE, default 0.08;
    }
    source "Schwarz 1890; |cos x + cos y + cos z| over its steepest slope sqrt(3), which is attained on the surface"
    example "schwarz_p(0.8, 0.08) & sphere(1)"
}

impl Primitive for SchwarzP {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let q = *p * N::splat(frequency(self.cell));
        let wave = q.x.cos() + q.y.cos() + q.z.cos();
        wall(wave, STEEPEST, self.cell, self.thickness)
    }

    fn sublevel(&self, _: f64) -> Bounds {
        Bounds::EVERYWHERE
    }

    fn traits(&self) -> Traits {
        Traits {
            class: Class::Bound,
            is_symmetric: [true; 3],
            ..Traits::EXACT
        }
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        fits(self.thickness, self.cell, HIGHEST / STEEPEST)
    }
}
