//! The octahedron.

use crate::catalogue::space_geometry::RegularFace;
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// The regular solid with eight triangles, its corners on the axes.
    Octahedron = "octahedron" {
        /// The distance of the corners from the origin, in scene units.
        radius: f64, Number, Range::POSITIVE, default 1.0;
    }
    derived {
        face: RegularFace = RegularFace::new([radius, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0; 3]);
    }
    source "folded by its mirrors (Coxeter), then the distance to one face; a distance, so its constant is 1"
    example "octahedron(1)"
}

impl Primitive for Octahedron {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        // The chamber is x >= y >= z >= 0.
        let q = p.abs();
        let (high, low) = (q.x.max(q.y), q.x.min(q.y));
        let (y, z) = (low.max(q.z), low.min(q.z));
        self.face.distance(Vec3::new(high.max(y), high.min(y), z))
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::centred([self.radius + level; 3])
    }

    fn traits(&self) -> Traits {
        Traits::CONVEX
    }
}
