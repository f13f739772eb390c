//! The Sierpinski tetrahedron.
//!
//! Every round keeps four half-sized tetrahedra at the corners. Mirrors between the first corner and the others fold
//! space onto the part where the first is nearest; they map the solid onto itself and never move a point away from its
//! nearest part, so the distance to the corner's copy is the distance to the whole, inside and outside.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};
use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

const SQRT_3: f64 = 1.732_050_807_568_877_2;
const SQRT_6: f64 = 2.449_489_742_783_178;

entry! {
    /// The Sierpinski tetrahedron: a tetrahedron of tetrahedra of tetrahedra, standing on a face, its centroid at the origin.
    Sierpinski = "sierpinski" {
        /// How often every tetrahedron is replaced by four; 0 leaves the whole one.
        iterations: f64, Count, Range::closed(0.0, 10.0), default 4.0;
        /// The full length of the edges, in scene units.
        size: f64, Number, Range::POSITIVE, default 1.6;
    }
    derived {
        half: f64 = 0.5 * FRAC_1_SQRT_2 * size;
    }
    source "Sierpinski 1915; mirrored onto the nearest corner round by round, then the distance to a tetrahedron: an exact distance, so its constant is 1"
    example "sierpinski(4, 1.8).rotate(y: 35deg)"
}

/// The axes of the scene for the cube with sides from -1 to 1 that has the corners `(1, 1, 1)`, `(1, -1, -1)`,
/// `(-1, 1, -1)` and `(-1, -1, 1)` of the tetrahedron: the first of them is up.
const AXES: [[f64; 3]; 3] = [
    [FRAC_1_SQRT_2, -FRAC_1_SQRT_2, 0.0],
    [1.0 / SQRT_3, 1.0 / SQRT_3, 1.0 / SQRT_3],
    [-1.0 / SQRT_6, -1.0 / SQRT_6, 2.0 / SQRT_6],
];

/// The point mirrored to where the corner `(1, 1, 1)` is nearest.
#[inline(always)]
fn to_first_corner<N: Number>(q: Vec3<N>) -> Vec3<N> {
    let Vec3 { x, y, z } = q;
    let (x, y) = mirrored(x, y);
    let (x, z) = mirrored(x, z);
    let (y, z) = mirrored(y, z);
    Vec3::new(x, y, z)
}

/// The point `(a, b)` of a plane, mirrored to where `a + b >= 0`.
#[inline(always)]
fn mirrored<N: Number>(a: N, b: N) -> (N, N) {
    let below = (a + b).min(N::splat(0.0));
    (a - below, b - below)
}

/// The lesser and the greater of two, also by their derivatives where they are equal: the point `(a, b)` of a plane,
/// mirrored at its diagonal.
#[inline(always)]
fn sorted<N: Number>(a: N, b: N) -> (N, N) {
    let above = (a - b).max(N::splat(0.0));
    (a - above, b + above)
}

/// The distance to the tetrahedron in a cube of sides `2 half`, where the corner `(1, 1, 1)` is the nearest.
#[inline(always)]
fn tetrahedron<N: Number>(q: Vec3<N>, half: f64) -> N {
    // Mirrored once more: the second corner is next, the fourth is last, so the face without the fourth is nearest.
    let (y, x) = sorted(q.x, q.y);
    let (z, x) = sorted(x, q.z);
    let (z, y) = sorted(y, z);
    // From the corner: up from the face, out of it across the edge to the second corner, and along that edge.
    let (zero, h) = (N::splat(0.0), N::splat(half));
    let above = (x + y - z - h) * N::splat(1.0 / SQRT_3);
    let across = ((x - h) * N::splat(2.0) - y + z) * N::splat(1.0 / SQRT_6);
    let along = (y + z) * N::splat(FRAC_1_SQRT_2) - N::splat(SQRT_2 * half);
    let from_edge = N::norm3(above, across, along.max(zero));
    N::select_lt(zero, above.min(across), from_edge, above)
}

impl Primitive for Sierpinski {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let [right, up, front] = AXES;
        let mut q = Vec3::splat(right) * p.x + Vec3::splat(up) * p.y + Vec3::splat(front) * p.z;
        let mut half = self.half;
        for _ in 0..self.iterations as u32 {
            half *= 0.5;
            q = to_first_corner(q) - Vec3::splat([half; 3]);
        }
        tetrahedron(to_first_corner(q), half)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let h = self.half;
        let low = [-SQRT_2 * h, -h / SQRT_3, -2.0 * h / SQRT_6];
        let high = [SQRT_2 * h, SQRT_3 * h, 4.0 * h / SQRT_6];
        Bounds::new(low, high).inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits {
            is_convex: self.iterations < 1.0,
            is_symmetric: [true, false, false],
            ..Traits::EXACT
        }
    }
}
