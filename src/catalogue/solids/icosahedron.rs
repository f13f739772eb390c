//! The icosahedron, and the mirrors that it shares with the dodecahedron.

use crate::catalogue::space_geometry::{RegularFace, reflected};
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

/// The unit normal of the mirror that bounds the chamber together with x = 0 and y = 0: (-1, -g, 1/g) / 2, where g is
/// the golden ratio.
const SLANTED: [f64; 3] = [-0.5, -0.809_016_994_374_947_4, 0.309_016_994_374_947_4];

/// The corner of the chamber where five turns meet: (1, 0, g) with length 1.
pub(super) const FIVEFOLD: [f64; 3] = [0.525_731_112_119_133_6, 0.0, 0.850_650_808_352_039_9];

/// The corner of the chamber where three turns meet: (0, 1/g, g) with length 1.
pub(super) const THREEFOLD: [f64; 3] = [0.0, 0.356_822_089_773_089_9, 0.934_172_358_962_715_7];

/// The corner of the chamber at the middle of an edge.
pub(super) const EDGE: [f64; 3] = [0.0, 0.0, 1.0];

entry! {
    /// The regular solid with twenty triangles, an edge across each axis.
    Icosahedron = "icosahedron" {
        /// The distance of the corners from the origin, in scene units.
        radius: f64, Number, Range::POSITIVE, default 1.0;
    }
    derived {
        face: RegularFace = RegularFace::new(FIVEFOLD.map(|c| c * radius), EDGE, THREEFOLD);
    }
    source "folded by its mirrors (Coxeter), then the distance to one face; a distance, so its constant is 1"
    example "icosahedron(1)"
}

/// The image of `p` in the chamber x, y >= 0 on the front of the slanted mirror. Five rounds of the mirrors, those at
/// right angles first, bring every point there (half the Coxeter number).
#[inline(always)]
pub(super) fn into_chamber<N: Number>(p: &Vec3<N>) -> Vec3<N> {
    let mut q = *p;
    for _ in 0..5 {
        q = reflected(Vec3::new(q.x.abs(), q.y.abs(), q.z), SLANTED);
    }
    q
}

impl Primitive for Icosahedron {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        self.face.distance(into_chamber(p))
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::centred([FIVEFOLD[2] * self.radius + level; 3])
    }

    fn traits(&self) -> Traits {
        Traits::CONVEX
    }
}
