//! Distances in the plane that several entries share.

use super::Bounds;
use crate::num::Number;
use std::f64::consts::PI;

/// A segment from `a` to `b` in the plane, prepared for distances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    start: [f64; 2],
    end: [f64; 2],
    along: [f64; 2],
    length: f64,
}

/// The distance to an edge, and what tells its sign.
pub(super) struct EdgeDistance<N> {
    /// The distance, never negative.
    pub distance: N,
    /// The same with the sign of the side (positive on the right), where the foot lies within the edge; `distance`
    /// where it is an end.
    pub signed: N,
    /// 1 where the foot lies within the edge, else 0.
    pub is_within: N,
}

impl<N: Number> EdgeDistance<N> {
    /// The distance from an edge where [`Edge::beside`] says this.
    #[inline(always)]
    pub fn of(side: N, beyond: N) -> Self {
        let (zero, one) = (N::splat(0.0), N::splat(1.0));
        // Past an end, the distance to it: the perpendicular part and what is left along the edge.
        let end = side.hypot(beyond);
        Self {
            distance: N::select_lt(zero, beyond, end, side.abs()),
            signed: N::select_lt(zero, beyond, end, side),
            is_within: one - N::select_lt(zero, beyond, one, zero),
        }
    }
}

impl Edge {
    /// The edge between two points; of length 0 where they are the same.
    pub fn new(a: [f64; 2], b: [f64; 2]) -> Self {
        let v = [b[0] - a[0], b[1] - a[1]];
        let length = v[0].hypot(v[1]);
        let unit = if length > 0.0 {
            v.map(|c| c / length)
        } else {
            // Any direction will do: a point is all ends.
            [1.0, 0.0]
        };
        Self {
            start: a,
            end: b,
            along: unit,
            length,
        }
    }

    /// The signed distance from the edge's line: positive to the right of the direction of travel, which is outside
    /// for a counter-clockwise outline. Stable at any distance, and linear: its gradient is the normal.
    #[inline(always)]
    pub fn side<N: Number>(&self, x: N, y: N) -> N {
        let (u, v) = (x - N::splat(self.start[0]), y - N::splat(self.start[1]));
        u * N::splat(self.along[1]) - v * N::splat(self.along[0])
    }

    /// The distance to the edge.
    #[inline(always)]
    pub fn distance<N: Number>(&self, x: N, y: N) -> EdgeDistance<N> {
        let (side, beyond) = self.beside(x, y);
        EdgeDistance::of(side, beyond)
    }

    /// The signed distance from the edge's line, as [`Edge::side`], and how far beyond its ends the foot lies: 0 within.
    #[inline(always)]
    pub fn beside<N: Number>(&self, x: N, y: N) -> (N, N) {
        let (u, v) = (x - N::splat(self.start[0]), y - N::splat(self.start[1]));
        let foot = u * N::splat(self.along[0]) + v * N::splat(self.along[1]);
        let side = u * N::splat(self.along[1]) - v * N::splat(self.along[0]);
        let beyond = (-foot).max(foot - N::splat(self.length));
        (side, beyond.max(N::splat(0.0)))
    }

    /// Its ends.
    pub fn ends(&self) -> [[f64; 2]; 2] {
        [self.start, self.end]
    }

    /// The distance to the edge with the sign of the side, past its ends too: the field of an outline whose nearest point
    /// is known to lie on this edge.
    #[inline(always)]
    pub fn signed_distance<N: Number>(&self, x: N, y: N) -> N {
        let found = self.distance(x, y);
        let zero = N::splat(0.0);
        let end = N::select_lt(self.side(x, y), zero, -found.distance, found.distance);
        N::select_lt(zero, found.is_within, found.signed, end)
    }

    /// Flips the sign of `sign` (1 or -1) where a line from `(x, y)` towards +x crosses the edge.
    #[inline(always)]
    pub fn crossing<N: Number>(&self, x: N, y: N, sign: N) -> N {
        let (y0, y1) = (self.start[1], self.end[1]);
        let (low, high) = (N::splat(y0.min(y1)), N::splat(y0.max(y1)));
        let side = if y1 > y0 {
            -self.side(x, y)
        } else {
            self.side(x, y)
        };
        // Left of the edge, at a height from `low` (with) to `high` (without).
        let is_left = N::select_lt(N::splat(0.0), side, -sign, sign);
        N::select_lt(y, low, sign, N::select_lt(y, high, is_left, sign))
    }
}

/// The edges of the closed outline through `corners`, in counter-clockwise order.
pub(super) fn outline(corners: &[[f64; 2]]) -> Vec<Edge> {
    let mut corners = corners.to_vec();
    if area(&corners) < 0.0 {
        corners.reverse();
    }
    let next = corners.iter().cycle().skip(1);
    corners
        .iter()
        .zip(next)
        .map(|(a, b)| Edge::new(*a, *b))
        .collect()
}

/// The signed area inside an outline: positive for corners that turn counter-clockwise.
pub(super) fn area(corners: &[[f64; 2]]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    corners
        .iter()
        .zip(next)
        .map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0]))
        .sum()
}

/// The signed distance to a convex outline of [`outline`]: inside, the nearest of the edges' lines.
#[inline(always)]
pub(super) fn convex_distance<N: Number>(edges: &[Edge], x: N, y: N) -> N {
    let mut nearest = N::splat(f64::INFINITY);
    let mut side = N::splat(f64::NEG_INFINITY);
    for edge in edges {
        nearest = nearest.min(edge.distance(x, y).distance);
        side = side.max(edge.side(x, y));
    }
    N::select_lt(N::splat(0.0), side, nearest, side)
}

/// The box around some points of the plane and all that is at most `distance` from it.
pub(super) fn bounds_around(points: &[[f64; 2]], distance: f64) -> Bounds {
    let mut bounds = Bounds::around(points.iter().map(|p| [p[0], p[1], 0.0])).inflate(distance);
    (bounds.low[2], bounds.high[2]) = (f64::NEG_INFINITY, f64::INFINITY);
    bounds
}

/// The signed distance from a large circle that passes through `(near, 0)` with its centre at `(-back, 0)`: as a
/// quotient, in which no digits are lost where the radius is much larger than what is seen of it.
#[inline(always)]
pub(super) fn flat_arc<N: Number>(x: N, y: N, near: f64, back: f64) -> N {
    let radius = N::splat(near + back);
    let power = (x - N::splat(near)) * (x + N::splat(near + 2.0 * back)) + y.square();
    power / ((x + N::splat(back)).hypot(y) + radius)
}

/// The mirrors of a regular polygon: they fold the plane into the wedge between the direction of a corner and the next
/// middle of a side, in about log2(n) reflections. Every point keeps its distance from whatever they leave unchanged.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Wedge {
    /// The unit normals of the mirrors, towards the side that is reflected.
    mirrors: Vec<[f64; 2]>,
}

impl Wedge {
    /// For a polygon with `n` corners, one of them on the positive y axis.
    pub fn new(n: f64) -> Self {
        let mut mirrors = Vec::new();
        // After the first mirror, x = 0, angles lie between 0 and n half steps; each mirror halves that.
        let mut steps = n;
        while steps > 1.0 && steps.is_finite() {
            steps = (0.5 * steps).ceil();
            let (sin, cos) = (PI * steps / n).sin_cos();
            mirrors.push([-sin, cos]);
        }
        Self { mirrors }
    }

    /// The point that `(x, y)` is folded to: how far along the direction of the corner, how far aside.
    #[inline(always)]
    pub fn fold<N: Number>(&self, x: N, y: N) -> (N, N) {
        let (mut along, mut aside) = (y, x.abs());
        for [a, b] in &self.mirrors {
            let (a, b) = (N::splat(*a), N::splat(*b));
            let behind = (along * a + aside * b).max(N::splat(0.0));
            let twice = behind + behind;
            along = along - twice * a;
            aside = aside - twice * b;
        }
        (along, aside)
    }
}

/// How many pairs of runs of edges [`crossing_edges`] looks at: some tenths of a second.
const MOST_PAIRS: usize = 1 << 24;

/// Two edges of the closed outline through `corners` that cross inside of both or run along each other, by the places of
/// their first corners. Edges may touch at a point: an outline then still has an inside next to every edge.
///
/// Boxes around runs of 2^k edges, halved where they overlap: about n log n steps for most outlines. Where long edges
/// lie close together it takes more; after [`MOST_PAIRS`] the outline is taken as it is.
pub(super) fn crossing_edges(corners: &[[f64; 2]]) -> Option<[usize; 2]> {
    let n = corners.len();
    let edge = |i: usize| [corners[i], corners[(i + 1) % n]];
    let mut levels = vec![
        (0..n)
            .map(|i| bounds_around(&edge(i), 0.0))
            .collect::<Vec<_>>(),
    ];
    while let Some(last) = levels.last().filter(|last| last.len() > 1) {
        levels.push(
            last.chunks(2)
                .map(|pair| pair.iter().fold(Bounds::EMPTY, |b, c| b.hull(*c)))
                .collect(),
        );
    }
    // Pairs of runs that may hold crossing edges; a run with itself first.
    let mut pairs = vec![[(levels.len() - 1, 0), (levels.len() - 1, 0)]];
    for _ in 0..MOST_PAIRS {
        let [a, b] = pairs.pop()?;
        let run = |(level, i): (usize, usize)| levels[level].get(i);
        let (Some(box_a), Some(box_b)) = (run(a), run(b)) else {
            continue;
        };
        let halves = |(level, i): (usize, usize)| [(level - 1, 2 * i), (level - 1, 2 * i + 1)];
        if a == b && a.0 > 0 {
            let [first, second] = halves(a);
            pairs.extend([[first, first], [first, second], [second, second]]);
        } else if a == b || box_a.intersect(*box_b).is_empty() {
            continue;
        } else if a.0 == 0 && b.0 == 0 {
            if cross(edge(a.1), edge(b.1)) {
                return Some([a.1.min(b.1), a.1.max(b.1)]);
            }
        } else if a.0 >= b.0 {
            pairs.extend(halves(a).map(|half| [half, b]));
        } else {
            pairs.extend(halves(b).map(|half| [a, half]));
        }
    }
    None
}

/// Whether two segments cross at a point inside of both.
fn cross([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    // Which side of the line from p to q the point r is on: 0 where rounding leaves it open.
    let side = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
        let (left, right) = ((q[0] - p[0]) * (r[1] - p[1]), (q[1] - p[1]) * (r[0] - p[0]));
        let noise = 1e-14 * (left.abs() + right.abs());
        if (left - right).abs() <= noise {
            0.0
        } else {
            (left - right).signum()
        }
    };
    let [of_c, of_d] = [side(a, b, c), side(a, b, d)];
    if of_c == 0.0 && of_d == 0.0 {
        return overlap([a, b], [c, d]) > 0.0;
    }
    of_c * of_d < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

/// How much of the first segment the second covers, as a share of it, where both lie on one line; rounding does not count.
fn overlap([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> f64 {
    let way = [b[0] - a[0], b[1] - a[1]];
    let squared = way[0] * way[0] + way[1] * way[1];
    let place = |p: [f64; 2]| ((p[0] - a[0]) * way[0] + (p[1] - a[1]) * way[1]) / squared;
    let (s, t) = (place(c), place(d));
    let covered = s.max(t).min(1.0) - s.min(t).max(0.0);
    if covered > 1e-12 { covered } else { 0.0 }
}
