//! The cross.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A cross of two equal bars around the origin of the plane, with rounded ends if wanted (`cross` is the product).
    Cross2 = "cross2" {
        /// The full length of the bars along x and y, in scene units.
        size: f64, Number, Range::POSITIVE, default 1.4;
        /// The full width of the bars, less than the length.
        width: f64, Number, Range::POSITIVE, default 0.5;
        /// The radius of the outer corners, at most half the width, and at most what a bar sticks out.
        round: f64, Number, Range::NOT_NEGATIVE, default 0.0;
    }
    source "Quilez, 2D distance functions (cross, rounded box); a distance, so its constant is 1"
    example "cross2(1.4, 0.5, round: 0.1).extrude(0.4)"
}

impl Primitive for Cross2 {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let zero = N::splat(0.0);
        let (half, round) = (N::splat(0.5 * self.width), N::splat(self.round));
        // Folded by its mirrors, the right bar's upper half is left.
        let (along, aside) = (p.x.abs().max(p.y.abs()), p.x.abs().min(p.y.abs()));
        let end = along - N::splat(0.5 * self.size);
        // Between the bars the corner is nearest, not the line of the bar's side.
        let (inner, line) = (half - along, aside - half);
        let side = N::select_lt(zero, inner, -inner.hypot(line), line);
        let (u, v) = (end + round, side + round);
        u.max(zero).hypot(v.max(zero)) + u.max(v).min(zero) - round
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let half = 0.5 * self.size + level;
        Bounds::centred([half, half, f64::INFINITY])
    }

    fn traits(&self) -> Traits {
        Traits {
            is_convex: false,
            ..Traits::CONVEX
        }
        .planar()
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        if self.width >= self.size {
            return Err((
                "width",
                format!("must be less than {}, the length of the bars", self.size),
            ));
        }
        let most = 0.5 * self.width.min(self.size - self.width);
        // A radius that was computed to fit may be off by rounding.
        if self.round > most * (1.0 + 1e-12) {
            return Err((
                "round",
                format!("must be at most {most}, so that it fits the ends of the bars"),
            ));
        }
        Ok(())
    }
}
