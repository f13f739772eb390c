//! The round cone.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// Two balls on the y axis and the cone that touches both: the origin is half way.
    RoundCone = "round_cone" {
        /// The radius of the lower ball, in scene units.
        bottom: f64, Number, Range::POSITIVE, default 0.5;
        /// The radius of the upper ball, in scene units.
        top: f64, Number, Range::POSITIVE, default 0.25;
        /// The full length along y with both ends, at least twice the larger radius.
        height: f64, Number, Range::POSITIVE, default 1.4;
    }
    derived {
        lower: f64 = bottom - 0.5 * height;
        length: f64 = height - bottom - top;
        normal: [f64; 2] = normal(bottom - top, height - bottom - top);
    }
    source "Quilez, distance functions (round cone); a distance, so its constant is 1"
    example "round_cone(0.5, 0.25, 1.4)"
}

/// The normal of the flank in the half-plane of r and y: it leans up by as much as the radius falls.
fn normal(fall: f64, length: f64) -> [f64; 2] {
    let lean = if length > 0.0 {
        (fall / length).clamp(-1.0, 1.0)
    } else {
        0.0
    };
    [((1.0 - lean) * (1.0 + lean)).sqrt(), lean]
}

impl Primitive for RoundCone {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let (zero, [out, up]) = (N::splat(0.0), self.normal);
        let (out, lean) = (N::splat(out), N::splat(up));
        let (r, y) = (p.x.hypot(p.z), p.y - N::splat(self.lower));
        // How far along the flank, whose ends are the circles where it touches the balls.
        let along = y * out - r * lean;
        let flank = r * out + y * lean - N::splat(self.bottom);
        let lower = r.hypot(y) - N::splat(self.bottom);
        let upper = r.hypot(y - N::splat(self.length)) - N::splat(self.top);
        let above = N::select_lt(out * N::splat(self.length), along, upper, flank);
        N::select_lt(along, zero, lower, above)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let r = self.bottom.max(self.top);
        Bounds::centred([r, 0.5 * self.height, r]).inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits {
            is_symmetric: [true, self.bottom == self.top, true],
            ..Traits::CONVEX
        }
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        let least = 2.0 * self.bottom.max(self.top);
        if self.height >= least {
            return Ok(());
        }
        Err((
            "height",
            format!("must be at least {least}, twice the larger radius"),
        ))
    }
}
