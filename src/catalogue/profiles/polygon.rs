//! The polygon.

use crate::catalogue::plane_geometry::{Edge, area, bounds_around, crossing_edges, outline};
use crate::catalogue::runs::Runs;
use crate::catalogue::{Argument, Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// The inside of a closed outline that does not cross itself, given corner by corner in either direction.
    Polygon = "polygon" {
        /// The corners, three or more.
        points: Vec<[f64; 2]>, Points, Range::ANY, default vec![[-0.6, -0.4], [0.6, -0.4], [0.0, 0.7]];
    }
    derived {
        runs: Runs = Runs::new(outline(&distinct(&points)));
    }
    source "Quilez, 2D distance functions (polygon), with the even-odd rule; a distance, so its constant is 1"
    example "polygon([[-0.6, -0.4], [0.6, -0.4], [0, 0.7]]).extrude(0.4)"
}

/// The corners without those that repeat the one before, also across the end of the list.
fn distinct(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut points = points.to_vec();
    points.dedup();
    while points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    points
}

impl Primitive for Polygon {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let nearest = self.runs.nearest(p.x, p.y);
        let sign = self.runs.parity(p.x, p.y);
        // Beside an edge its line tells the side, smoothly through zero; at a corner the even-odd rule does.
        let half = N::splat(0.5);
        N::select_lt(
            half,
            nearest.is_within,
            nearest.signed,
            nearest.distance * sign,
        )
    }

    fn sublevel(&self, level: f64) -> Bounds {
        bounds_around(&self.points, level)
    }

    fn traits(&self) -> Traits {
        let is_left = |edge: &Edge| self.points.iter().all(|p| edge.side(p[0], p[1]) <= 0.0);
        Traits {
            is_convex: self.runs.edges().iter().all(is_left),
            ..Traits::EXACT
        }
        .planar()
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        let corners = distinct(&self.points);
        let n = corners.len();
        if n < 3 {
            return Err((
                "points",
                format!("must be three or more that differ, but there are {n}"),
            ));
        }
        if let Some(edges) = crossing_edges(&corners) {
            let [first, second] = edges.map(|i| {
                let (a, b) = (corners[i], corners[(i + 1) % n]);
                format!("from {} to {}", Argument::Vector2(a), Argument::Vector2(b))
            });
            return Err((
                "points",
                format!(
                    "must not cross themselves, but the edge {first} crosses the edge {second} or runs along it"
                ),
            ));
        }
        if area(&self.points) == 0.0 {
            return Err(("points", "must enclose an area, but theirs is 0".into()));
        }
        Ok(())
    }
}
