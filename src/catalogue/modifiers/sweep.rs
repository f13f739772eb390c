//! Boxes around what turns, and slopes of maps: what the constants and bounds of warps have in common.

use crate::catalogue::Bounds;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The largest singular value of the matrix with rows (a, b) and (0, 1): half of the sum and half of the difference of
/// both singular values, whose squares are the squared Frobenius norm plus and minus twice the determinant.
pub(super) fn largest_stretch(a: f64, b: f64) -> f64 {
    0.5 * ((a.abs() + 1.0).hypot(b) + (a.abs() - 1.0).hypot(b))
}

/// The range of the cosine over the angles from `low` to `high`.
fn cosines(low: f64, high: f64) -> [f64; 2] {
    let holds = |angle: f64| ((low - angle) / TAU).ceil() * TAU + angle <= high;
    let (a, b) = (libm::cos(low), libm::cos(high));
    let is_round = high - low >= TAU;
    [
        if is_round || holds(PI) {
            -1.0
        } else {
            a.min(b)
        },
        if is_round || holds(0.0) {
            1.0
        } else {
            a.max(b)
        },
    ]
}

/// A box around all that `bounds` becomes when it is turned about `axis` by any angle from the first to the second of
/// `turns` (counter-clockwise as seen from the tip of the axis), and scaled across it by any factor between `factors`,
/// which are positive.
pub(super) fn swept(bounds: Bounds, axis: usize, turns: [f64; 2], factors: [f64; 2]) -> Bounds {
    if bounds.is_empty() {
        return bounds;
    }
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let [least, most] = [factors[0].min(factors[1]), factors[0].max(factors[1])];
    let mut swept = bounds;
    if turns == [0.0; 2] {
        for i in [u, v] {
            swept.low[i] = (bounds.low[i] * least).min(bounds.low[i] * most);
            swept.high[i] = (bounds.high[i] * least).max(bounds.high[i] * most);
        }
        return swept;
    }
    for i in [u, v] {
        (swept.low[i], swept.high[i]) = (f64::INFINITY, f64::NEG_INFINITY);
    }
    for (x, y) in corners(&bounds, u, v) {
        let (radius, angle) = (x.hypot(y), libm::atan2(y, x));
        for (i, start) in [(u, angle), (v, angle - FRAC_PI_2)] {
            let range = if radius.is_finite() {
                cosines(
                    start + turns[0].min(turns[1]),
                    start + turns[0].max(turns[1]),
                )
            } else {
                [-1.0, 1.0]
            };
            swept.low[i] = swept.low[i].min(radius * (range[0] * least).min(range[0] * most));
            swept.high[i] = swept.high[i].max(radius * (range[1] * least).max(range[1] * most));
        }
    }
    swept
}

/// The corners of `bounds` across an axis, in the coordinates `u` and `v`, in cyclic order.
pub(super) fn corners(bounds: &Bounds, u: usize, v: usize) -> [(f64, f64); 4] {
    let ([x0, y0], [x1, y1]) = (
        [bounds.low[u], bounds.low[v]],
        [bounds.high[u], bounds.high[v]],
    );
    [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number that looks random, from -1 to 1.
    fn wild(seed: f64) -> f64 {
        libm::sin(seed * 78.233 + 1.0) * 43758.5 % 1.0
    }

    #[test]
    fn swept_boxes_hold_what_turns_and_touch_it() {
        for case in 0..100 {
            let number = |i: usize| wild(f64::from(case) + 0.01 * i as f64);
            let low: [f64; 3] = std::array::from_fn(number);
            let bounds = Bounds::new(low, std::array::from_fn(|i| low[i] + 1.1 + number(i + 3)));
            let turns = [3.0 * number(6), 3.0 * number(7)];
            let factors = [1.0, 1.1 + number(8)];
            let axis = case as usize % 3;
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let around = swept(bounds, axis, turns, factors);
            let mut found = Bounds::EMPTY;
            for step in 0..=4000 {
                let t = f64::from(step) / 4000.0;
                let (s, c) = libm::sincos(turns[0] + (turns[1] - turns[0]) * t);
                for factor in factors {
                    for (x, y) in corners(&bounds, u, v) {
                        let mut p = bounds.low;
                        (p[u], p[v]) = (factor * (x * c - y * s), factor * (x * s + y * c));
                        assert!(around.inflate(1e-12).contains(p), "{p:?}, {around:?}");
                        found = found.hull(Bounds::new(p, p));
                    }
                }
            }
            for i in [u, v] {
                assert!(found.low[i] - around.low[i] < 1e-4);
                assert!(around.high[i] - found.high[i] < 1e-4);
            }
        }
    }

    #[test]
    fn the_largest_stretch_is_that_of_the_steepest_direction() {
        for (a, b) in [(1.0, 0.0), (0.3, 0.4), (2.0, 1.0), (-1.5, 0.7), (0.0, 3.0)] {
            let found = (0..100_000).fold(0.0_f64, |most, i| {
                let (s, c) = libm::sincos(f64::from(i) * 1e-4);
                most.max((a * c + b * s).hypot(s))
            });
            assert!((largest_stretch(a, b) - found).abs() < 1e-7);
        }
    }
}
