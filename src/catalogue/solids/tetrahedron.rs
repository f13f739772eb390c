//! The tetrahedron.

use crate::catalogue::space_geometry::{RegularFace, cross, dot, reflected, unit};
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

/// The directions of the corners: one up, one to the front below, one to each side behind.
const CORNERS: [[f64; 3]; 4] = [
    [0.0, 1.0, 0.0],
    [0.0, -1.0 / 3.0, 0.942_809_041_582_063_4],
    [0.816_496_580_927_726, -1.0 / 3.0, -0.471_404_520_791_031_7],
    [-0.816_496_580_927_726, -1.0 / 3.0, -0.471_404_520_791_031_7],
];

/// The direction of the middle of the edge between the corners above and in front.
const EDGE: [f64; 3] = [0.0, CORNERS[0][1] + CORNERS[1][1], CORNERS[1][2]];

/// The direction of the middle of the face right of that edge: away from the corner on the left.
const FACE: [f64; 3] = [-CORNERS[3][0], -CORNERS[3][1], -CORNERS[3][2]];

entry! {
    /// The regular solid with four triangles, standing on one of them, its centre at the origin.
    Tetrahedron = "tetrahedron" {
        /// The distance of the corners from the origin, in scene units: three times that of the faces.
        radius: f64, Number, Range::POSITIVE, default 1.0;
    }
    derived {
        face: RegularFace = RegularFace::new(CORNERS[0].map(|c| c * radius), EDGE, FACE);
    }
    source "folded by its mirrors (Coxeter), then the distance to one face; a distance, so its constant is 1"
    example "tetrahedron(1)"
}

/// The mirror through the origin and two directions, its unit normal on the side of a third.
fn mirror(a: [f64; 3], b: [f64; 3], inside: [f64; 3]) -> [f64; 3] {
    let normal = unit(cross(a, b));
    if dot(normal, inside) < 0.0 {
        normal.map(|c| -c)
    } else {
        normal
    }
}

impl Primitive for Tetrahedron {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let side = mirror(EDGE, FACE, CORNERS[0]);
        let slope = mirror(FACE, CORNERS[0], EDGE);
        let mut q = *p;
        // Two rounds of the mirrors, those at right angles first, bring every point into the chamber.
        for _ in 0..2 {
            q = q.with_component(0, q.x.abs());
            q = reflected(reflected(q, side), slope);
        }
        self.face.distance(q)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::around(CORNERS.map(|v| v.map(|c| c * self.radius))).inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits {
            is_symmetric: [true, false, false],
            ..Traits::CONVEX
        }
    }
}
