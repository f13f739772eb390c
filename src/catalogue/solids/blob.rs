//! The blob: balls of influence that melt together.
//!
//! A ball about c adds `(1 - |p - c|^2 / r^2)^3` within its radius r, and nothing outside. The solid is where the sum
//! exceeds a threshold. The steepest slope of the sum depends on where the balls are: it is found once, by cutting the
//! space around them into boxes, over each of which the slope has a bound.

use crate::catalogue::enclosure::{beyond, enclosure};
use crate::catalogue::{Bounds, Class, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};
use std::collections::BinaryHeap;

/// The largest number of balls.
const MOST_BALLS: usize = 256;

/// How many balls the search for the steepest slope may look at, in all boxes together: about 20 ns each.
const MOST_WORK: usize = 1 << 20;

/// The search ends when the steepest slope is known this closely.
const ENOUGH: f64 = 1.04;

entry! {
    /// Balls that melt together where they meet (metaballs): the points where the sum of their influences exceeds a threshold.
    Blob = "blob" {
        /// The centres of the balls, at most 256.
        points: Vec<[f64; 3]>, Points3, Range::ANY, default vec![[-0.5, -0.3, 0.0], [0.5, -0.3, 0.0], [0.0, 0.4, 0.0]];
        /// The distance at which the influence of a ball ends, in scene units.
        radius: f64, Number, Range::POSITIVE, default 0.9;
        /// How much influence is inside, where one ball alone has 1 in its centre: more is thinner.
        threshold: f64, Number, Range::closed(0.05, 0.95), default 0.4;
    }
    derived {
        scale: f64 = 1.0 / steepest(&points, radius);
        region: Bounds = enclosure(Bounds::around(points.iter().copied()).inflate(radius), |p| {
            missing(&points, radius, threshold, scale, &Vec3::splat(p))
        });
    }
    source "Wyvill, McPheeters and Wyvill 1986 for the idea; the sum of (1 - d^2 / r^2)^3 over its steepest slope, which is found within 4 % by subdivision with Taylor's formula"
    example "blob([[-0.5, -0.3, 0], [0.5, -0.3, 0], [0, 0.4, 0]], 0.9, 0.4)"
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    norm([a[0] - b[0], a[1] - b[1], a[2] - b[2]])
}

/// The steepest slope of the sum of influences, at most [`ENOUGH`] times too large where [`MOST_WORK`] allows.
fn steepest(points: &[[f64; 3]], radius: f64) -> f64 {
    // In units of the radius: a slope is steep or not at any scale.
    let points: Vec<_> = points.iter().map(|p| p.map(|c| c / radius)).collect();
    let first = Part::new(Bounds::around(points.iter().copied()).inflate(1.0), &points);
    let (mut known, mut work) = (first.found, 0);
    let mut parts = BinaryHeap::from([first]);
    while let Some(top) = parts.peek() {
        if top.bound <= ENOUGH * known || work > MOST_WORK {
            break;
        }
        let top = parts.pop().expect("peeked just now");
        work += 2 * top.balls.len();
        for half in top.halves() {
            let half = Part::new(half, &top.balls);
            known = known.max(half.found);
            parts.push(half);
        }
    }
    // A part in 10^12 for the rounding of sums.
    let bound = parts.peek().map_or(0.0, |part| part.bound) * (1.0 + 1e-12);
    // No sum is less steep than one ball alone.
    bound.max(slope(FLATTEST)) / radius
}

/// How far from the centre of a ball of radius 1 its influence falls most steeply.
const FLATTEST: f64 = 0.447_213_595_499_957_9;

/// A bound of the third derivatives of the influence of a ball of radius 1, `24 u |1 - u^2 + 2 s^2 (1 - 2 u^2)|` along the
/// radius and `48 u (1 - u^2) s sqrt(1 - s^2)` across, in a direction with cosine s to it: largest for u = s = 1.
const THIRD: f64 = 48.0;

/// The same up to distance [`INNER`], where it is largest for u^2 = 1/5, s = 1.
const THIRD_INNER: f64 = 21.47;

/// Up to which distance from the centre the bound [`THIRD_INNER`] holds.
const INNER: f64 = 0.8;

/// How steeply the influence of a ball of radius 1 falls at distance `u`: `6 u (1 - u^2)^2`.
fn slope(u: f64) -> f64 {
    let rest = (1.0 - u * u).max(0.0);
    6.0 * u * rest * rest
}

/// A box, with a slope found in it and a bound of all slopes.
struct Part {
    bounds: Bounds,
    /// The centres of the balls that reach into the box.
    balls: Vec<[f64; 3]>,
    found: f64,
    bound: f64,
}

impl Part {
    fn new(bounds: Bounds, points: &[[f64; 3]]) -> Self {
        let centre = bounds.centre();
        let reach = apart(centre, bounds.high);
        // The gradient and its derivative in the middle, how fast that changes, and what the balls have at most each.
        let mut gradient = [0.0; 3];
        let mut hessian = [[0.0; 3]; 3];
        let (mut third, mut apiece) = (0.0, 0.0);
        let mut balls = Vec::new();
        for p in points {
            let v: [f64; 3] = std::array::from_fn(|i| centre[i] - p[i]);
            let u = apart(centre, *p);
            let (near, far) = ((u - reach).max(0.0), u + reach);
            if near >= 1.0 {
                continue;
            }
            balls.push(*p);
            let rest = (1.0 - u * u).max(0.0);
            for i in 0..3 {
                gradient[i] -= 6.0 * rest * rest * v[i];
                hessian[i][i] -= 6.0 * rest * rest;
                for j in 0..3 {
                    hessian[i][j] += 24.0 * rest * v[i] * v[j];
                }
            }
            third += if far <= INNER { THIRD_INNER } else { THIRD };
            apiece += slope(FLATTEST.clamp(near, far));
        }
        let found = norm(gradient);
        let turn = norm(hessian.map(|row| dot(row, gradient)));
        let spread = norm(hessian.map(norm));
        // |g + H v|^2 <= |g|^2 + 2 |H g| |v| + |H|^2 |v|^2, and what Taylor's formula leaves.
        let squared = found * found + 2.0 * turn * reach + (spread * reach).powi(2);
        let taylor = squared.sqrt() + 0.5 * third * reach * reach;
        Self {
            bounds,
            balls,
            found,
            bound: taylor.min(apiece),
        }
    }

    /// The box cut across its longest side.
    fn halves(&self) -> [Bounds; 2] {
        let size = self.bounds.size();
        let axis = (0..3).fold(0, |a, b| if size[b] > size[a] { b } else { a });
        let middle = self.bounds.centre()[axis];
        let (mut below, mut above) = (self.bounds, self.bounds);
        below.high[axis] = middle;
        above.low[axis] = middle;
        [below, above]
    }
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Part {}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Part {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.bound.total_cmp(&other.bound)
    }
}

/// What is missing from the threshold, over the steepest slope; where there is no influence, at least the distance to the
/// nearest ball.
#[inline(always)]
fn missing<N: Number>(
    points: &[[f64; 3]],
    radius: f64,
    threshold: f64,
    scale: f64,
    p: &Vec3<N>,
) -> N {
    let (zero, one) = (N::splat(0.0), N::splat(1.0));
    let per_square = N::splat(1.0 / (radius * radius));
    let mut influence = zero;
    let mut nearest = N::splat(f64::INFINITY);
    for centre in points {
        let squared = (*p - Vec3::splat(*centre)).length_squared() * per_square;
        let rest = (one - squared).max(zero);
        influence = influence + rest.square() * rest;
        nearest = nearest.min(squared);
    }
    // Inside of a ball its distance is negative, and so is what is missing inside of the solid: the larger tells.
    let beyond = (nearest.sqrt() - one) * N::splat(radius);
    ((N::splat(threshold) - influence) * N::splat(scale)).max(beyond)
}

impl Primitive for Blob {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let missing = missing(&self.points, self.radius, self.threshold, self.scale, p);
        missing.max(beyond(&self.region, p))
    }

    fn sublevel(&self, level: f64) -> Bounds {
        self.region.inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits {
            class: Class::Bound,
            ..Traits::EXACT
        }
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        let count = self.points.len();
        if (1..=MOST_BALLS).contains(&count) {
            return Ok(());
        }
        let message = format!("must be 1 to {MOST_BALLS} points, but there are {count}");
        Err(("points", message))
    }
}
