//! The triangle.

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
        normal: [f64; 3] = unit_normal(a, b, c);
    }
    source "Quilez, distance functions (triangle); a distance, so its constant is 1"
    example "triangle([1, 0, 0], [0, 1, 0], [0, 0, 1])"
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn norm(a: [f64; 3]) -> f64 {
    a[0].hypot(a[1]).hypot(a[2])
}

impl Triangle {
    /// The unit normal of the front; zero where the corners lie on one line.
    pub fn unit_normal(&self) -> [f64; 3] {
        self.normal
    }
}

fn unit_normal(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> [f64; 3] {
    let n = cross(minus(b, a), minus(c, a));
    let length = norm(n);
    if length > 0.0 {
        n.map(|x| x / length)
    } else {
        [0.0; 3]
    }
}

/// The vector from the segment between `a` and `b` to `p`.
#[inline(always)]
fn from_segment<N: Number>(p: &Vec3<N>, a: [f64; 3], b: [f64; 3]) -> Vec3<N> {
    let v = minus(b, a);
    let squared = v.iter().map(|c| c * c).sum::<f64>();
    let w = *p - Vec3::splat(a);
    let inverse = if squared > 0.0 { 1.0 / squared } else { 0.0 };
    let foot = (w.dot(Vec3::splat(v)) * N::splat(inverse)).clamp(N::splat(0.0), N::splat(1.0));
    w - Vec3::splat(v) * foot
}

impl Primitive for Triangle {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let n = self.normal;
        let zero = N::splat(0.0);
        let mut edges = N::splat(f64::INFINITY);
        let mut inside = N::splat(1.0);
        for (a, b) in [(self.a, self.b), (self.b, self.c), (self.c, self.a)] {
            edges = edges.min(from_segment(p, a, b).length());
            // Above the edge's line, on the side of the triangle.
            let side = (*p - Vec3::splat(a)).dot(Vec3::splat(cross(n, minus(b, a))));
            inside = N::select_lt(side, zero, zero, inside);
        }
        let plane = (*p - Vec3::splat(self.a)).dot(Vec3::splat(n)).abs();
        N::select_lt(zero, inside, plane, edges)
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
