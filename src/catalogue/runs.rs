//! Edges in runs: of outlines and strokes with many edges those that are far away are left out.
//!
//! A run is some edges one behind the other, with the box around them. It is looked into only where it may hold the nearest edge:
//! the square of the distance from its box is below that of the nearest edge so far, and below that from the far side of
//! another box. For the even-odd rule a run counts as one edge from its first point to its last, but in its box. Each lane
//! decides by itself, so what it finds does not depend on the others; a run is left out where no lane needs it.

use super::plane_geometry::{Edge, EdgeDistance};
use crate::num::Number;

/// Outlines with fewer edges than this are one run.
const MANY: usize = 12;

/// Edges in runs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Runs {
    edges: Vec<Edge>,
    runs: Vec<Run>,
}

/// Some edges one behind the other.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Run {
    first: usize,
    end: usize,
    /// The box around them.
    centre: [f64; 2],
    half: [f64; 2],
    /// The heights of its ends, the lower one first.
    heights: [f64; 2],
}

impl Run {
    fn new(edges: &[Edge], first: usize, end: usize) -> Self {
        let run = &edges[first..end];
        let points = || run.iter().flat_map(Edge::ends);
        let low = [0, 1].map(|i| points().fold(f64::INFINITY, |low, p| low.min(p[i])));
        let high = [0, 1].map(|i| points().fold(f64::NEG_INFINITY, |high, p| high.max(p[i])));
        let [a, b] = [run[0].ends()[0][1], run[run.len() - 1].ends()[1][1]];
        // The border belongs to the box, whatever rounding says.
        let room = |i: usize| 1e-6 * low[i].abs().max(high[i].abs()).max(high[i] - low[i]);
        Self {
            first,
            end,
            centre: [0, 1].map(|i| 0.5 * (low[i] + high[i])),
            half: [0, 1].map(|i| 0.5 * (high[i] - low[i]) + room(i)),
            heights: [a.min(b), a.max(b)],
        }
    }

    /// How far a point is beyond the box along each axis, negative inside.
    #[inline(always)]
    fn beyond<N: Number>(&self, x: N, y: N) -> [N; 2] {
        [
            (x - N::splat(self.centre[0])).abs() - N::splat(self.half[0]),
            (y - N::splat(self.centre[1])).abs() - N::splat(self.half[1]),
        ]
    }

    /// The square of the distance from the box.
    #[inline(always)]
    fn least<N: Number>(&self, x: N, y: N) -> N {
        let [u, v] = self.beyond(x, y);
        let zero = N::splat(0.0);
        u.max(zero).square() + v.max(zero).square()
    }

    /// The square of the distance to the farthest corner of the box.
    #[inline(always)]
    fn most<N: Number>(&self, x: N, y: N) -> N {
        let [u, v] = self.beyond(x, y);
        let (width, height) = (2.0 * self.half[0], 2.0 * self.half[1]);
        (u + N::splat(width)).square() + (v + N::splat(height)).square()
    }

    /// As [`Edge::crossing`], outside of the box: there the whole run is like an edge between its ends.
    #[inline(always)]
    fn crossing<N: Number>(&self, x: N, y: N, sign: N) -> N {
        let (low, high) = (N::splat(self.heights[0]), N::splat(self.heights[1]));
        let is_left = N::select_lt(x, N::splat(self.centre[0]), -sign, sign);
        N::select_lt(y, low, sign, N::select_lt(y, high, is_left, sign))
    }
}

impl Runs {
    /// The edges, each of which begins where the one before ends.
    pub fn new(edges: Vec<Edge>) -> Self {
        // A run costs about as much as an edge, and about three are looked into.
        let length = if edges.len() < MANY {
            edges.len().max(1)
        } else {
            (edges.len() as f64 / 3.0).sqrt().ceil() as usize
        };
        let starts = (0..edges.len()).step_by(length);
        let runs = starts.map(|first| Run::new(&edges, first, (first + length).min(edges.len())));
        Self {
            runs: runs.collect(),
            edges,
        }
    }

    /// The edges.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// The nearest edge.
    #[inline(always)]
    pub fn nearest<N: Number>(&self, x: N, y: N) -> EdgeDistance<N> {
        if N::LEAVES_OUT {
            self.nearest_by_runs(x, y)
        } else {
            self.nearest_of_all(x, y)
        }
    }

    #[inline(always)]
    fn nearest_of_all<N: Number>(&self, x: N, y: N) -> EdgeDistance<N> {
        let mut nearest = EdgeDistance {
            distance: N::splat(f64::INFINITY),
            signed: N::splat(f64::INFINITY),
            is_within: N::splat(0.0),
        };
        for edge in &self.edges {
            let found = edge.distance(x, y);
            let (new, old) = (found.distance, nearest.distance);
            nearest = EdgeDistance {
                signed: N::select_lt(new, old, found.signed, nearest.signed),
                is_within: N::select_lt(new, old, found.is_within, nearest.is_within),
                distance: old.min(new),
            };
        }
        nearest
    }

    /// As [`Runs::nearest_of_all`], by squares.
    #[inline(always)]
    fn nearest_by_runs<N: Number>(&self, x: N, y: N) -> EdgeDistance<N> {
        let zero = N::splat(0.0);
        let mut nearest = N::splat(f64::INFINITY);
        if self.runs.len() > 1 {
            for run in &self.runs {
                nearest = nearest.min(run.most(x, y));
            }
            // A little more than that, so that what is that far is found.
            nearest = nearest * N::splat(1.001) + N::splat(1e-30);
        }
        // What is no place has no nearest edge.
        let (mut side, mut beyond) = (N::splat(f64::NAN), zero);
        for run in &self.runs {
            let least = run.least(x, y);
            if !least.may_be_below(nearest) {
                continue;
            }
            for edge in &self.edges[run.first..run.end] {
                let (u, v) = edge.beside(x, y);
                let found = u.square() + v.square();
                let bound = N::select_lt(least, nearest, nearest, zero);
                side = N::select_lt(found, bound, u, side);
                beyond = N::select_lt(found, bound, v, beyond);
                nearest = N::select_lt(found, bound, found, nearest);
            }
        }
        EdgeDistance::of(side, beyond)
    }

    /// 1 where a line from `(x, y)` towards +x crosses an even number of edges, else -1.
    #[inline(always)]
    pub fn parity<N: Number>(&self, x: N, y: N) -> N {
        let zero = N::splat(0.0);
        let mut sign = N::splat(1.0);
        if !N::LEAVES_OUT || self.runs.len() == 1 {
            return crossings(&self.edges, x, y, sign);
        }
        for run in &self.runs {
            let [u, v] = run.beyond(x, y);
            let outside = u.max(v);
            let as_one = run.crossing(x, y, sign);
            if outside.may_be_below(zero) {
                let crossed = crossings(&self.edges[run.first..run.end], x, y, sign);
                sign = N::select_lt(outside, zero, crossed, as_one);
            } else {
                sign = as_one;
            }
        }
        sign
    }
}

/// As [`Edge::crossing`], of all these edges.
#[inline(always)]
fn crossings<N: Number>(edges: &[Edge], x: N, y: N, sign: N) -> N {
    let mut sign = sign;
    for edge in edges {
        sign = edge.crossing(x, y, sign);
    }
    sign
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::plane_geometry::outline;
    use crate::num::{F64x32, Lanes, samples::Samples};
    use std::f64::consts::TAU;

    const SEED: u64 = 0x09e5;

    /// The corners of a star with `n` corners and some of its edges level.
    fn star(samples: &mut Samples, n: usize) -> Vec<[f64; 2]> {
        let corner = |i: usize| {
            let angle = TAU * i as f64 / n as f64;
            let radius = samples.uniform(0.3, 1.0);
            let grid = |x: f64| (x * 16.0).round() / 16.0;
            [3.0 + radius * angle.cos(), grid(radius * angle.sin())]
        };
        (0..n).map(corner).collect()
    }

    #[test]
    fn runs_say_what_all_edges_say() {
        let mut samples = Samples::new(SEED);
        for n in [3, 11, 12, 40, 200] {
            let corners = star(&mut samples, n);
            let runs = Runs::new(outline(&corners));
            assert_eq!(runs.runs.len() > 1, n >= MANY);
            for i in 0..2000 {
                // Any point, and points at the height of a corner, where lines towards +x meet two edges at once.
                let (x, y) = (samples.uniform(1.0, 5.0), samples.uniform(-2.0, 2.0));
                let y = if i % 2 == 0 { y } else { corners[i % n][1] };
                let (few, all) = (runs.nearest(x, y), runs.nearest_of_all(x, y));
                let what = format!("{n} corners, ({x}, {y}), seed {SEED:#x}");
                assert!((few.distance - all.distance).abs() <= 1e-15, "{what}");
                let odd = runs.edges().iter().fold(1.0, |s, e| e.crossing(x, y, s));
                assert_eq!(runs.parity(x, y), odd, "{what}");
            }
        }
    }

    #[test]
    fn no_place_has_no_distance() {
        let mut samples = Samples::new(SEED);
        for n in [3, 40] {
            let runs = Runs::new(outline(&star(&mut samples, n)));
            for (x, y) in [(f64::NAN, 0.0), (3.0, f64::NAN), (f64::INFINITY, 0.0)] {
                assert!(!runs.nearest(x, y).distance.is_finite());
            }
        }
    }

    #[test]
    fn lanes_of_single_precision_see_the_same_inside() {
        let mut samples = Samples::new(SEED);
        for n in [11, 40, 200] {
            // Far from the origin, so that coordinates are rounded.
            let corners = star(&mut samples, n)
                .into_iter()
                .map(|[x, y]| [x + 100.0, y - 60.0]);
            let runs = Runs::new(outline(&corners.collect::<Vec<_>>()));
            for _ in 0..2000 {
                let (x, y) = (
                    samples.uniform(101.0, 105.0) as f32,
                    samples.uniform(-62.0, -58.0) as f32,
                );
                let (near, exact) = (
                    runs.nearest(x, y),
                    runs.nearest_of_all(f64::from(x), f64::from(y)),
                );
                assert!((f64::from(near.distance) - exact.distance).abs() < 1e-4);
                if exact.distance > 1e-3 {
                    let sign = runs.parity(f64::from(x), f64::from(y));
                    assert_eq!(
                        f64::from(runs.parity(x, y)),
                        sign,
                        "({x}, {y}), seed {SEED:#x}"
                    );
                }
            }
        }
    }

    #[test]
    fn lanes_find_what_they_find_alone() {
        let mut samples = Samples::new(SEED);
        let corners = star(&mut samples, 90);
        let runs = Runs::new(outline(&corners));
        for _ in 0..200 {
            // Some close together, some far away.
            let width = samples.uniform(0.0, 3.0);
            let middle = samples.uniform(2.0, 4.0);
            let [x, y] = [middle, 0.0]
                .map(|c| Lanes(std::array::from_fn(|_| c + samples.uniform(-width, width))));
            let (wide, sign): (EdgeDistance<F64x32>, F64x32) =
                (runs.nearest(x, y), runs.parity(x, y));
            for i in 0..32 {
                let alone = runs.nearest(x.0[i], y.0[i]);
                assert_eq!(wide.distance.0[i].to_bits(), alone.distance.to_bits());
                assert_eq!(wide.signed.0[i].to_bits(), alone.signed.to_bits());
                assert_eq!(sign.0[i], runs.parity(x.0[i], y.0[i]));
            }
        }
    }
}
