//! The quadrilateral.

use crate::catalogue::space_geometry::{cross, dot, minus, normal_of, triangle_distance};
use crate::catalogue::{Bounds, Primitive, Range, Traits, Triangle, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A sheet with four corners and without thickness, folded along the line from a to c if they are not in one plane.
    Quad = "quad" {
        /// The first corner; the others follow around the border.
        a: [f64; 3], Vector3, Range::ANY, default [-0.8, 0.0, 0.6];
        /// The second corner.
        b: [f64; 3], Vector3, Range::ANY, default [0.8, 0.0, 0.6];
        /// The third corner.
        c: [f64; 3], Vector3, Range::ANY, default [0.8, 0.0, -0.6];
        /// The fourth corner.
        d: [f64; 3], Vector3, Range::ANY, default [-0.8, 0.0, -0.6];
    }
    derived {
        normals: [[f64; 3]; 2] = [normal_of([a, b, c]), normal_of([a, c, d])];
    }
    source "the nearer of two triangles (Quilez, distance functions: triangle, quad); a distance, so its constant is 1"
    example "quad([-0.8, -0.3, 0.6], [0.8, -0.3, 0.6], [0.8, 0.3, -0.6], [-0.8, 0.3, -0.6])"
}

impl Quad {
    /// The two triangles that it is made of, with their fronts on its front.
    pub fn halves(&self) -> [Triangle; 2] {
        [
            Triangle::new(self.a, self.b, self.c),
            Triangle::new(self.a, self.c, self.d),
        ]
    }
}

impl Primitive for Quad {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let first = triangle_distance(p, [self.a, self.b, self.c], self.normals[0]);
        first.min(triangle_distance(
            p,
            [self.a, self.c, self.d],
            self.normals[1],
        ))
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::around([self.a, self.b, self.c, self.d]).inflate(level)
    }

    fn traits(&self) -> Traits {
        let corners = [self.a, self.b, self.c, self.d];
        let normal = self.normals[0];
        let is_flat = corners
            .iter()
            .all(|p| dot(normal, minus(*p, self.a)) == 0.0);
        let turns_left = |i: usize| {
            let [p, q, r] = [0, 1, 2].map(|k| corners[(i + k) % 4]);
            dot(normal, cross(minus(q, p), minus(r, q))) >= 0.0
        };
        Traits {
            is_convex: is_flat && self.normals[1] == normal && (0..4).all(turns_left),
            is_sheet: true,
            ..Traits::EXACT
        }
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        if self.normals[0] == [0.0; 3] {
            return Err((
                "b",
                "must not lie on the line through `a` and `c`: that half has no area".into(),
            ));
        }
        if self.normals[1] == [0.0; 3] {
            return Err((
                "d",
                "must not lie on the line through `a` and `c`: that half has no area".into(),
            ));
        }
        Ok(())
    }
}
