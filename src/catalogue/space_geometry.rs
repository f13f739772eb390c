//! Vectors and distances in space that several entries share.

use crate::num::{Number, Vec3};

/// The vector from `b` to `a`.
pub(super) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

/// The point half way between `a` and `b`.
pub(super) fn middle(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| 0.5 * a[i] + 0.5 * b[i])
}

/// The scalar product.
pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector product, right-handed.
pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The length of a vector.
pub(super) fn norm(a: [f64; 3]) -> f64 {
    a[0].hypot(a[1]).hypot(a[2])
}

/// The vector with length 1; zero where its length is 0.
pub(super) fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = norm(a);
    if length > 0.0 {
        a.map(|x| x / length)
    } else {
        [0.0; 3]
    }
}

/// The normal of the side from which the corners turn counter-clockwise; zero where they lie on one line.
pub(super) fn normal_of([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    unit(cross(minus(b, a), minus(c, a)))
}

/// The vector from the segment between `a` and `b` to `p`.
#[inline(always)]
fn from_segment<N: Number>(p: &Vec3<N>, a: [f64; 3], b: [f64; 3]) -> Vec3<N> {
    let v = minus(b, a);
    let squared = dot(v, v);
    let w = *p - Vec3::splat(a);
    let inverse = if squared > 0.0 { 1.0 / squared } else { 0.0 };
    let foot = (w.dot(Vec3::splat(v)) * N::splat(inverse)).clamp(N::splat(0.0), N::splat(1.0));
    w - Vec3::splat(v) * foot
}

/// The distance to the segment between `a` and `b`.
#[inline(always)]
pub(super) fn segment_distance<N: Number>(p: &Vec3<N>, a: [f64; 3], b: [f64; 3]) -> N {
    from_segment(p, a, b).length()
}

/// The distance to a flat triangle with these corners and this normal; to its edges where the normal is zero.
#[inline(always)]
pub(super) fn triangle_distance<N: Number>(
    p: &Vec3<N>,
    corners: [[f64; 3]; 3],
    normal: [f64; 3],
) -> N {
    let zero = N::splat(0.0);
    let [a, b, c] = corners;
    let mut edges = N::splat(f64::INFINITY);
    let mut inside = if normal == [0.0; 3] {
        zero
    } else {
        N::splat(1.0)
    };
    for (a, b) in [(a, b), (b, c), (c, a)] {
        edges = edges.min(segment_distance(p, a, b));
        // Above the edge's line, on the side of the triangle.
        let side = (*p - Vec3::splat(a)).dot(Vec3::splat(cross(normal, minus(b, a))));
        inside = N::select_lt(side, zero, zero, inside);
    }
    let plane = (*p - Vec3::splat(a)).dot(Vec3::splat(normal)).abs();
    N::select_lt(zero, inside, plane, edges)
}

/// The point `p` on the side of a mirror through the origin to which its unit normal points: reflected if it is not.
#[inline(always)]
pub(super) fn reflected<N: Number>(p: Vec3<N>, normal: [f64; 3]) -> Vec3<N> {
    let normal = Vec3::splat(normal);
    let behind = normal.dot(p).min(N::splat(0.0));
    p - normal * (behind + behind)
}

/// A face of a regular solid as one chamber of the solid's mirrors sees it: a right triangle between the middle of the
/// face, the middle of an edge and a corner. A point that was folded into the chamber has its nearest point there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RegularFace {
    /// The unit normal of the face, and its distance from the origin.
    normal: ([f64; 3], f64),
    /// The direction from the middle of the face to the middle of the edge, and where the edge is.
    outward: ([f64; 3], f64),
    /// The direction from the middle of the edge to the corner, and where the corner is.
    along: ([f64; 3], f64),
}

impl RegularFace {
    /// The face of the solid with this corner, between the directions of its middle and of the middle of an edge.
    pub fn new(corner: [f64; 3], edge: [f64; 3], face: [f64; 3]) -> Self {
        let [edge, face] = [unit(edge), unit(face)];
        let edge_middle = edge.map(|c| c * dot(corner, edge));
        let face_middle = face.map(|c| c * dot(corner, face));
        let outward = unit(minus(edge_middle, face_middle));
        let along = unit(minus(corner, edge_middle));
        Self {
            normal: (face, dot(corner, face)),
            outward: (outward, dot(corner, outward)),
            along: (along, dot(corner, along)),
        }
    }

    /// The signed distance from the solid at a point of the chamber.
    #[inline(always)]
    pub fn distance<N: Number>(&self, p: Vec3<N>) -> N {
        let zero = N::splat(0.0);
        let height = Vec3::splat(self.normal.0).dot(p) - N::splat(self.normal.1);
        let past_edge = Vec3::splat(self.outward.0).dot(p) - N::splat(self.outward.1);
        let past_corner = Vec3::splat(self.along.0).dot(p) - N::splat(self.along.1);
        let outside = N::norm3(height.max(zero), past_edge.max(zero), past_corner.max(zero));
        N::select_lt(height, zero, height, outside)
    }
}
