//! The polygon.

use crate::catalogue::plane_geometry::Edge;
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// The inside of a closed outline that does not cross itself, given corner by corner in either direction.
    Polygon = "polygon" {
        /// The corners, three or more.
        points: Vec<[f64; 2]>, Points, Range::ANY, default vec![[-0.6, -0.4], [0.6, -0.4], [0.0, 0.7]];
    }
    derived {
        edges: Vec<Edge> = outline(&points);
    }
    source "Quilez, 2D distance functions (polygon), with the even-odd rule; a distance, so its constant is 1"
    example "polygon([[-0.6, -0.4], [0.6, -0.4], [0, 0.7]]).extrude(0.4)"
}

/// The signed area: positive for corners that turn counter-clockwise.
fn area(points: &[[f64; 2]]) -> f64 {
    let next = points.iter().cycle().skip(1);
    points
        .iter()
        .zip(next)
        .map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0]))
        .sum()
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

/// The edges in counter-clockwise order.
fn outline(points: &[[f64; 2]]) -> Vec<Edge> {
    let mut points = distinct(points);
    if area(&points) < 0.0 {
        points.reverse();
    }
    points
        .iter()
        .zip(points.iter().cycle().skip(1))
        .map(|(a, b)| Edge::new(*a, *b))
        .collect()
}

impl Primitive for Polygon {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let mut nearest = N::splat(f64::INFINITY);
        let mut signed = nearest;
        let mut is_within = N::splat(0.0);
        let mut sign = N::splat(1.0);
        for edge in &self.edges {
            let found = edge.distance(p.x, p.y);
            signed = N::select_lt(found.distance, nearest, found.signed, signed);
            is_within = N::select_lt(found.distance, nearest, found.is_within, is_within);
            nearest = nearest.min(found.distance);
            sign = edge.crossing(p.x, p.y, sign);
        }
        // Beside an edge its line tells the side, smoothly through zero; at a corner the even-odd rule does.
        N::select_lt(N::splat(0.5), is_within, signed, nearest * sign)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let mut bounds =
            Bounds::around(self.points.iter().map(|p| [p[0], p[1], 0.0])).inflate(level);
        (bounds.low[2], bounds.high[2]) = (f64::NEG_INFINITY, f64::INFINITY);
        bounds
    }

    fn traits(&self) -> Traits {
        let is_left = |edge: &Edge| self.points.iter().all(|p| edge.side(p[0], p[1]) <= 0.0);
        Traits {
            is_convex: self.edges.iter().all(is_left),
            ..Traits::EXACT
        }
        .planar()
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        let corners = distinct(&self.points).len();
        if corners < 3 {
            return Err((
                "points",
                format!("must be three or more that differ, but there are {corners}"),
            ));
        }
        if area(&self.points) == 0.0 {
            return Err(("points", "must enclose an area, but theirs is 0".into()));
        }
        Ok(())
    }
}
