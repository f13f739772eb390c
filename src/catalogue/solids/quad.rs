//! The quadrilateral.

use crate::catalogue::space_geometry::{cross, dot, minus};
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
        // In a box: the largest primitive is what every node has room for.
        halves: Box<[Triangle; 2]> = Box::new([Triangle::new(a, b, c), Triangle::new(a, c, d)]);
    }
    source "the nearer of two triangles (Quilez, distance functions: triangle, quad); a distance, so its constant is 1"
    example "quad([-0.8, -0.3, 0.6], [0.8, -0.3, 0.6], [0.8, 0.3, -0.6], [-0.8, 0.3, -0.6])"
}

impl Quad {
    /// The two triangles that it is made of.
    pub fn halves(&self) -> &[Triangle; 2] {
        &self.halves
    }
}

impl Primitive for Quad {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let [first, second] = &*self.halves;
        first.distance(p).min(second.distance(p))
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::around([self.a, self.b, self.c, self.d]).inflate(level)
    }

    fn traits(&self) -> Traits {
        let corners = [self.a, self.b, self.c, self.d];
        let [normal, other] = self.halves.each_ref().map(Triangle::unit_normal);
        let is_flat = corners
            .iter()
            .all(|p| dot(normal, minus(*p, self.a)) == 0.0);
        let turns_left = |i: usize| {
            let [p, q, r] = [0, 1, 2].map(|k| corners[(i + k) % 4]);
            dot(normal, cross(minus(q, p), minus(r, q))) >= 0.0
        };
        Traits {
            is_convex: is_flat && other == normal && (0..4).all(turns_left),
            is_sheet: true,
            ..Traits::EXACT
        }
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        let [first, second] = self.halves.each_ref().map(Triangle::unit_normal);
        if first == [0.0; 3] {
            return Err((
                "b",
                "must not lie on the line through `a` and `c`: that half has no area".into(),
            ));
        }
        if second == [0.0; 3] {
            return Err((
                "d",
                "must not lie on the line through `a` and `c`: that half has no area".into(),
            ));
        }
        Ok(())
    }
}
