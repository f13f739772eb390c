//! The cut sphere.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// What is left of a ball above a flat cut across the y axis: a dome; the origin is half way up.
    CutSphere = "cut_sphere" {
        /// The radius of the ball, in scene units.
        radius: f64, Number, Range::POSITIVE, default 0.8;
        /// The full length along y of what is left, at most twice the radius.
        height: f64, Number, Range::POSITIVE, default 1.0;
    }
    derived {
        rim: f64 = (height * (2.0 * radius - height)).max(0.0).sqrt();
    }
    source "Quilez, distance functions (cut sphere); a distance, so its constant is 1"
    example "cut_sphere(0.8, 1)"
}

impl Primitive for CutSphere {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let zero = N::splat(0.0);
        // Seen from the centre of the ball, the cut lies at `cut` and ends in the rim.
        let cut = self.radius - self.height;
        let (r, y) = (
            p.x.hypot(p.z),
            p.y - N::splat(0.5 * self.height - self.radius),
        );
        let ball = r.hypot(y) - N::splat(self.radius);
        let below = N::splat(cut) - y;
        let past_rim = r * N::splat(cut) - y * N::splat(self.rim);
        let base = (r - N::splat(self.rim)).max(zero).hypot(below);
        // Outside, the ball is nearest beyond its surface within the cone of the rim.
        let outside = N::select_lt(zero, past_rim.max(-ball), base, ball);
        let depth = ball.max(below);
        N::select_lt(zero, depth, outside, depth)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let r = if self.height < self.radius {
            self.rim
        } else {
            self.radius
        };
        Bounds::centred([r, 0.5 * self.height, r]).inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits {
            is_symmetric: [true, false, true],
            ..Traits::CONVEX
        }
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        let most = 2.0 * self.radius;
        if self.height <= most {
            return Ok(());
        }
        Err((
            "height",
            format!("must be at most {most}, twice the radius"),
        ))
    }
}
