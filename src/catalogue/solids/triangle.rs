//! The triangle.

use crate::catalogue::space_geometry::{normal_of, triangle_distance};
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A flat triangle without thickness; its front is the side from which a, b, c turn counter-clockwise.
    Triangle = "triangle" {
        /// The first corner.
        a: [f64; 3], Vector3, Range::ANY, default [1.0, 0.0, 0.0];
        /// The second corner.
        b: [f64; 3], Vector3, Range::ANY, default [0.0, 1.0, 0.0];
        /// The third corner.
        c: [f64; 3], Vector3, Range::ANY, default [0.0, 0.0, 1.0];
    }
    derived {
        normal: [f64; 3] = normal_of([a, b, c]);
    }
    source "Quilez, distance functions (triangle); a distance, so its constant is 1"
    example "triangle([1, 0, 0], [0, 1, 0], [0, 0, 1])"
}

impl Triangle {
    /// The unit normal of the front; zero where the corners lie on one line.
    pub fn unit_normal(&self) -> [f64; 3] {
        self.normal
    }
}

impl Primitive for Triangle {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        triangle_distance(p, [self.a, self.b, self.c], self.normal)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::around([self.a, self.b, self.c]).inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits {
            is_convex: true,
            is_sheet: true,
            ..Traits::EXACT
        }
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        if self.normal != [0.0; 3] {
            return Ok(());
        }
        Err((
            "c",
            "must not lie on the line through `a` and `b`: the triangle has no area".into(),
        ))
    }
}
