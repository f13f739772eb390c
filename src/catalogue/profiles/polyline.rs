//! The polyline.

use crate::catalogue::plane_geometry::{Edge, bounds_around};
use crate::catalogue::runs::Runs;
use crate::catalogue::{Bounds, Class, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

/// A bolt, to start from.
const BOLT: [[f64; 2]; 4] = [[-0.8, -0.4], [-0.2, 0.5], [0.2, -0.5], [0.8, 0.4]];

entry! {
    /// A stroke along straight lines from point to point of the plane, with round joins and ends.
    Polyline = "polyline" {
        /// The points on its middle line, two or more.
        points: Vec<[f64; 2]>, Points, Range::ANY, default BOLT.to_vec();
        /// The full width of the stroke, in scene units.
        width: f64, Number, Range::POSITIVE, default 0.2;
    }
    derived {
        runs: Runs = Runs::new(points.windows(2).map(|pair| Edge::new(pair[0], pair[1])).collect());
    }
    source "Quilez, 2D distance functions (segment), the nearest of several; a distance from the middle line, so its constant is 1"
    example "polyline([[-0.8, -0.4], [-0.2, 0.5], [0.2, -0.5], [0.8, 0.4]], 0.2).extrude(0.3)"
}

impl Primitive for Polyline {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        self.runs.nearest(p.x, p.y).distance - N::splat(0.5 * self.width)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        bounds_around(&self.points, 0.5 * self.width + level)
    }

    fn traits(&self) -> Traits {
        let is_straight = self.runs.edges().len() == 1;
        Traits {
            // Inside of a bend the surface is further away than the stroke's half width says.
            class: if is_straight {
                Class::Exact
            } else {
                Class::Bound
            },
            is_convex: is_straight,
            ..Traits::EXACT
        }
        .planar()
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        match self.points.len() {
            0 | 1 => Err((
                "points",
                format!("must be two or more, but there are {}", self.points.len()),
            )),
            _ => Ok(()),
        }
    }
}
