//! The heart.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};
use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

entry! {
    /// A heart around the origin of the plane, its tip below: a square on its corner with half a disc on two sides.
    Heart = "heart" {
        /// The full width along x, in scene units; the height is 0.914 of it.
        width: f64, Number, Range::POSITIVE, default 1.4;
    }
    derived {
        diagonal: f64 = width / (0.5 + FRAC_1_SQRT_2);
    }
    source "Quilez, 2D distance functions (heart); a distance, so its constant is 1"
    example "heart(1.4).extrude(0.4)"
}

impl Heart {
    /// How high the middle of the box around the heart is above the tip.
    fn middle(&self) -> f64 {
        self.diagonal * (0.375 + 0.125 * SQRT_2)
    }
}

impl Primitive for Heart {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let zero = N::splat(0.0);
        let half = N::splat(FRAC_1_SQRT_2);
        let (x, y) = (p.x.abs(), p.y + N::splat(self.middle()));
        let (centre_x, centre_y) = (
            N::splat(0.25 * self.diagonal),
            N::splat(0.75 * self.diagonal),
        );
        let disc = (x - centre_x).hypot(y - centre_y) - N::splat(0.25 * SQRT_2 * self.diagonal);
        // The square: its right lower side, signed, and the notch between the discs.
        let side = N::select_lt(x + y, zero, x.hypot(y), (x - y) * half);
        let notch = x.hypot(y - N::splat(self.diagonal));
        N::select_lt(N::splat(self.diagonal), x + y, disc, side.max(-notch))
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::centred([
            0.5 * self.width + level,
            self.middle() + level,
            f64::INFINITY,
        ])
    }

    fn traits(&self) -> Traits {
        Traits {
            is_symmetric: [true, false, true],
            ..Traits::EXACT
        }
        .planar()
    }
}
