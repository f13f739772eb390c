//! Distances in the plane that several entries share.

use crate::num::Number;

/// A segment from `a` to `b` in the plane, prepared for distances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    start: [f64; 2],
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

impl Edge {
    /// The edge between two points; of length 0 where they are the same.
    pub fn new(a: [f64; 2], b: [f64; 2]) -> Self {
        let v = [b[0] - a[0], b[1] - a[1]];
        let length = v[0].hypot(v[1]);
        let unit = if length > 0.0 {
            v.map(|c| c / length)
        } else {
            [0.0; 2]
        };
        Self {
            start: a,
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
        let (zero, one, length) = (N::splat(0.0), N::splat(1.0), N::splat(self.length));
        let (u, v) = (x - N::splat(self.start[0]), y - N::splat(self.start[1]));
        let foot = u * N::splat(self.along[0]) + v * N::splat(self.along[1]);
        let side = u * N::splat(self.along[1]) - v * N::splat(self.along[0]);
        // Past an end, the distance to it: the perpendicular part and what is left along the edge.
        let beyond = (-foot).max(foot - length);
        let end = side.hypot(beyond.max(zero));
        let outside = N::select_lt(zero, beyond, one, zero);
        EdgeDistance {
            distance: N::select_lt(zero, beyond, end, side.abs()),
            signed: N::select_lt(zero, beyond, end, side),
            is_within: one - outside,
        }
    }

    /// Flips the sign of `sign` (1 or -1) where a line from `(x, y)` towards +x crosses the edge.
    #[inline(always)]
    pub fn crossing<N: Number>(&self, x: N, y: N, sign: N) -> N {
        let (y0, y1) = (self.start[1], self.start[1] + self.along[1] * self.length);
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
