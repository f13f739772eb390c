//! Lattice functions over intervals: the gradients and points of the cells that a box touches are known, so their
//! polynomials and distances are evaluated over the box; a box that touches many cells gets what holds everywhere.

use super::lattice::{fade, fade_slope, gradient, hash_at, scattered};
use super::{Interval, Lattice, Number};

/// What a lattice function and its partial derivatives are over a box.
#[derive(Clone, Copy, Debug)]
struct Ranges {
    value: Interval,
    slope: [Interval; 3],
}

impl Ranges {
    /// What holds everywhere.
    fn anywhere(lattice: Lattice) -> Self {
        let ([low, high], steepest) = (lattice.range(), lattice.lipschitz());
        Self {
            value: Interval::new(low, high),
            slope: [Interval::new(-steepest, steepest); 3],
        }
    }

    fn hull(self, o: Self) -> Self {
        let [a, b, c] = self.slope;
        let [d, e, f] = o.slope;
        Self {
            value: self.value.hull(o.value),
            slope: [a.hull(d), b.hull(e), c.hull(f)],
        }
    }
}

/// The range of a lattice function.
pub(super) fn value(lattice: Lattice, at: [Interval; 3]) -> Interval {
    ranges(lattice, at).value
}

/// The ranges of its partial derivatives.
pub(super) fn slope(lattice: Lattice, at: [Interval; 3]) -> [Interval; 3] {
    ranges(lattice, at).slope
}

fn ranges(lattice: Lattice, at: [Interval; 3]) -> Ranges {
    let anywhere = Ranges::anywhere(lattice);
    if at.iter().any(|x| x.magnitude() > FAR) {
        return anywhere;
    }
    let found = match lattice {
        Lattice::Noise => noise(at),
        Lattice::Voronoi => voronoi(at),
    };
    let Some(found) = found else { return anywhere };
    let [a, b, c] = found.slope;
    let [d, e, f] = anywhere.slope;
    Ranges {
        value: common(found.value, anywhere.value),
        slope: [common(a, d), common(b, e), common(c, f)],
    }
}

/// What both intervals hold; both hold the same values, up to rounding.
fn common(a: Interval, b: Interval) -> Interval {
    Interval::new(a.lo.max(b.lo).min(b.hi), a.hi.min(b.hi).max(b.lo))
}

/// Up to here `f64` numbers the cells exactly.
const FAR: f64 = 1e15;

/// By how much the value and the slopes of noise in `f64` can be off: eight corners with a few roundings each, of numbers
/// below 4, and mixtures of them.
const ROUNDING: f64 = 1e-13;

/// The first and last of the cells that the interval touches, if they are few.
fn few_cells(x: Interval, most: f64) -> Option<[f64; 2]> {
    let [first, last] = [x.lo.floor(), x.hi.floor()];
    (last - first < most).then_some([first, last])
}

/// Noise over a box that touches at most two cells along each axis: the hull of what it is in each.
fn noise(at: [Interval; 3]) -> Option<Ranges> {
    let mut cells = [[0.0; 2]; 3];
    for (ends, x) in cells.iter_mut().zip(at) {
        *ends = few_cells(x, 2.0)?;
    }
    let mut all: Option<Ranges> = None;
    for n in 0..8usize {
        let choice = [n & 1, n >> 1 & 1, n >> 2];
        let is_again = |axis: usize| choice[axis] == 1 && cells[axis][0] == cells[axis][1];
        if (0..3).any(is_again) {
            continue;
        }
        let corner: [f64; 3] = std::array::from_fn(|axis| cells[axis][choice[axis]]);
        let inside: [Interval; 3] = std::array::from_fn(|axis| within(at[axis], corner[axis]));
        let here = noise_in_cell(corner, inside);
        all = Some(all.map_or(here, |ranges| ranges.hull(here)));
    }
    let wide = |x: Interval| x + Interval::new(-ROUNDING, ROUNDING);
    all.map(|ranges| Ranges {
        value: wide(ranges.value),
        slope: ranges.slope.map(wide),
    })
}

/// The part of `x` in the cell that starts at `start`, counted from there.
fn within(x: Interval, start: f64) -> Interval {
    let inside = x - Interval::point(start);
    Interval::new(inside.lo.clamp(0.0, 1.0), inside.hi.clamp(0.0, 1.0))
}

/// `a` for t = 0, `b` for t = 1, straight between; exact but for rounding, as it rises in `a` and `b`.
fn lerp(a: Interval, b: Interval, t: Interval) -> Interval {
    let between = |a: f64, b: f64, t: f64| {
        Interval::point(a) + (Interval::point(b) - Interval::point(a)) * Interval::point(t)
    };
    let low = between(a.lo, b.lo, t.lo).hull(between(a.lo, b.lo, t.hi));
    let high = between(a.hi, b.hi, t.lo).hull(between(a.hi, b.hi, t.hi));
    low.hull(high)
}

/// The mean by the weights `t` along three axes of eight corners, numbered as in [`noise_in_cell`].
fn lerp3(corners: [Interval; 8], t: [Interval; 3]) -> Interval {
    let edge = |i: usize| lerp(corners[i], corners[i + 1], t[0]);
    let face = |i: usize| lerp(edge(i), edge(i + 2), t[1]);
    lerp(face(0), face(4), t[2])
}

/// [`fade`] over part of [0, 1], where it rises.
fn fade_over(t: Interval) -> Interval {
    let [low, high] = [t.lo, t.hi].map(|t| fade(Interval::point(t)));
    let ends = low.hull(high);
    Interval::new(ends.lo.clamp(0.0, 1.0), ends.hi.clamp(0.0, 1.0))
}

/// [`fade_slope`] over part of [0, 1]: it rises to 15/8 at 1/2 and falls again.
fn fade_slope_over(t: Interval) -> Interval {
    let [low, high] = [t.lo, t.hi].map(|t| fade_slope(Interval::point(t)));
    let ends = low.hull(high);
    let has_peak = t.lo <= 0.5 && t.hi >= 0.5;
    Interval::new(
        ends.lo.max(0.0),
        if has_peak { 1.875 } else { ends.hi.min(1.875) },
    )
}

/// Noise in the cell at `start`, over the places `at` in it. Bits 0, 1, 2 of a corner's number say on which side it lies.
fn noise_in_cell(start: [f64; 3], at: [Interval; 3]) -> Ranges {
    let side = |n: usize, axis: usize| f64::from((n >> axis & 1) as u8);
    let gradients: [[f64; 3]; 8] = std::array::from_fn(|n| {
        gradient(hash_at(std::array::from_fn(|axis| {
            start[axis] + side(n, axis)
        })))
    });
    // The product of a gradient with the way from its corner, and the difference of two: linear in the place.
    let linear = |g: [f64; 3], constant: f64| {
        (0..3).fold(Interval::point(constant), |sum, axis| {
            sum + Interval::point(g[axis]) * at[axis]
        })
    };
    let constant = |n: usize| {
        -(0..3)
            .map(|axis| gradients[n][axis] * side(n, axis))
            .sum::<f64>()
    };
    let t: [Interval; 3] = at.map(fade_over);
    let heights = std::array::from_fn(|n| linear(gradients[n], constant(n)));
    let slope = std::array::from_fn(|axis| {
        let flat = std::array::from_fn(|n| Interval::point(gradients[n][axis]));
        // The difference across the axis does not depend on the side there: both corners of an edge hold it.
        let across = std::array::from_fn(|n| {
            let (near, far) = (n & !(1 << axis), n | 1 << axis);
            let g = std::array::from_fn(|k| gradients[far][k] - gradients[near][k]);
            linear(g, constant(far) - constant(near))
        });
        lerp3(flat, t) + fade_slope_over(at[axis]) * lerp3(across, t)
    });
    let value = lerp3(heights, t);
    let from_middle = mean_value(gradients, at, slope);
    Ranges {
        value: common(value, from_middle),
        slope,
    }
}

/// The value in the middle, and as far from it as the slopes reach.
fn mean_value(gradients: [[f64; 3]; 8], at: [Interval; 3], slope: [Interval; 3]) -> Interval {
    let middle = at.map(Interval::mid);
    let weight = |n: usize| -> f64 {
        (0..3)
            .map(|axis| match n >> axis & 1 {
                0 => 1.0 - fade(middle[axis]),
                _ => fade(middle[axis]),
            })
            .product()
    };
    let height = |n: usize| -> f64 {
        (0..3)
            .map(|axis| gradients[n][axis] * (middle[axis] - f64::from((n >> axis & 1) as u8)))
            .sum()
    };
    let value: f64 = (0..8).map(|n| weight(n) * height(n)).sum();
    (0..3).fold(
        Interval::new(value - ROUNDING, value + ROUNDING),
        |sum, axis| sum + slope[axis] * (at[axis] - Interval::point(middle[axis])),
    )
}

/// The distance to the nearest scattered point over a box that touches few cells.
fn voronoi(at: [Interval; 3]) -> Option<Ranges> {
    let half = Interval::point(0.5);
    let mut cells = [[0.0; 2]; 3];
    for (ends, x) in cells.iter_mut().zip(at) {
        let [first, last] = few_cells(x - half, 3.0)?;
        *ends = [first - 1.0, last + 2.0];
    }
    let mut ways: Vec<([Interval; 3], Interval)> = Vec::new();
    let along = |axis: usize| {
        let [first, last] = cells[axis];
        (0..=(last - first) as u32).map(move |n| first + f64::from(n))
    };
    for i in along(0) {
        for j in along(1) {
            for k in along(2) {
                let corner = [i, j, k];
                let place = scattered(hash_at(corner));
                let way: [Interval; 3] = std::array::from_fn(|axis| {
                    at[axis] - Interval::point(corner[axis]) - Interval::point(place[axis])
                });
                ways.push((way, Interval::norm3(way[0], way[1], way[2])));
            }
        }
    }
    let ends = |(low, high): (f64, f64), (_, length): &([Interval; 3], Interval)| {
        (low.min(length.lo), high.min(length.hi))
    };
    let (low, high) = ways.iter().fold((f64::INFINITY, f64::INFINITY), ends);
    let wide = |x: Interval| x + Interval::new(-ROUNDING, ROUNDING);
    let value = wide(Interval::new(low, high));
    // Only points that may be the nearest somewhere count.
    let slopes = ways.iter().filter(|(_, length)| length.lo <= value.hi);
    let slope = slopes.map(|(way, length)| way.map(|d| wide(d.direction_cosine(*length))));
    let slope = slope.reduce(|a, b| std::array::from_fn(|axis| a[axis].hull(b[axis])))?;
    Some(Ranges { value, slope })
}
