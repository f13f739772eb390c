//! The box frame.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// The twelve edges of a box as square bars.
    BoxFrame = "box_frame" {
        /// The full lengths of the sides along x, y and z, in scene units; a single number makes a cube.
        size: [f64; 3], Factors, Range::POSITIVE, default [1.0; 3];
        /// The width of a bar, at most half the shortest side.
        width: f64, Number, Range::POSITIVE, default 0.1;
    }
    derived {
        half: [f64; 3] = size.map(|s| 0.5 * s);
    }
    source "the nearest of three bars in the folded space; Quilez, distance functions (box frame); its constant is 1"
    example "box_frame(1.2, 0.1)"
}

/// The distance to a box whose corner is at the origin and which reaches to minus infinity, at `q`.
#[inline(always)]
fn corner<N: Number>(x: N, y: N, z: N) -> N {
    let zero = N::splat(0.0);
    N::norm3(x.max(zero), y.max(zero), z.max(zero)) + x.max(y).max(z).min(zero)
}

impl Primitive for BoxFrame {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let half_width = N::splat(0.5 * self.width);
        let outer = p.abs() - Vec3::splat(self.half);
        // Across a bar, the distance from its middle line, which runs half a width inside of the box.
        let inner = (outer + Vec3::splat([0.5 * self.width; 3])).abs()
            - Vec3::new(half_width, half_width, half_width);
        let along_x = corner(outer.x, inner.y, inner.z);
        let along_y = corner(inner.x, outer.y, inner.z);
        let along_z = corner(inner.x, inner.y, outer.z);
        along_x.min(along_y).min(along_z)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::centred(self.half).inflate(level)
    }

    fn traits(&self) -> Traits {
        // Inside of a corner, three bars overlap.
        Traits {
            is_convex: false,
            class: crate::catalogue::Class::Bound,
            ..Traits::CONVEX
        }
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        let most = self.half.into_iter().fold(f64::INFINITY, f64::min);
        if self.width <= most {
            return Ok(());
        }
        Err((
            "width",
            format!("must be at most {most}, half the shortest side"),
        ))
    }
}
