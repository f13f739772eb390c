//! The triangle in the plane.

use crate::catalogue::plane_geometry::{Edge, area, bounds_around, convex_distance, outline};
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// The inside of a triangle in the plane (`triangle` is a sheet in space).
    Triangle2 = "triangle2" {
        /// The first corner.
        a: [f64; 2], Vector2, Range::ANY, default [-0.7, -0.5];
        /// The second corner.
        b: [f64; 2], Vector2, Range::ANY, default [0.7, -0.5];
        /// The third corner.
        c: [f64; 2], Vector2, Range::ANY, default [0.0, 0.7];
    }
    derived {
        edges: Vec<Edge> = outline(&[a, b, c]);
    }
    source "Quilez, 2D distance functions (triangle); a distance, so its constant is 1"
    example "triangle2([-0.7, -0.5], [0.7, -0.5], [0.2, 0.7]).extrude(0.4)"
}

impl Primitive for Triangle2 {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        convex_distance(&self.edges, p.x, p.y)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        bounds_around(&[self.a, self.b, self.c], level)
    }

    fn traits(&self) -> Traits {
        Traits {
            is_convex: true,
            ..Traits::EXACT
        }
        .planar()
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        if area(&[self.a, self.b, self.c]) != 0.0 {
            return Ok(());
        }
        Err((
            "c",
            "must not lie on the line through `a` and `b`: the triangle has no area".into(),
        ))
    }
}
