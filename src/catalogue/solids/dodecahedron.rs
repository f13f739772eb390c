//! The dodecahedron.

use crate::catalogue::space_geometry::RegularFace;
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

use super::icosahedron::{EDGE, FIVEFOLD, THREEFOLD, into_chamber};

entry! {
    /// The regular solid with twelve pentagons, an edge across each axis.
    Dodecahedron = "dodecahedron" {
        /// The distance of the corners from the origin, in scene units.
        radius: f64, Number, Range::POSITIVE, default 1.0;
    }
    derived {
        face: RegularFace = RegularFace::new(THREEFOLD.map(|c| c * radius), EDGE, FIVEFOLD);
    }
    source "folded by its mirrors (Coxeter), then the distance to one face; a distance, so its constant is 1"
    example "dodecahedron(1)"
}

impl Primitive for Dodecahedron {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        self.face.distance(into_chamber(p))
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::centred([THREEFOLD[2] * self.radius + level; 3])
    }

    fn traits(&self) -> Traits {
        Traits::CONVEX
    }
}
