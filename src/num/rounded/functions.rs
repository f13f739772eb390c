//! The functions of numbers with rounding errors, each for the operations by which `f32` computes it.

use super::single::{LEAST, LEAST_LENGTH, UNIT, is_in_reach, kernel_error, rounded, wider};
use super::{Rounded, apart, common, times};
use crate::num::{Interval, Lattice, Number};
use std::f64::consts::{FRAC_1_SQRT_2, PI};

const NOT_NEGATIVE: Interval = Interval {
    lo: 0.0,
    hi: f64::INFINITY,
};

/// Up to here the cells of a lattice are found exactly, with a margin of a factor of 4.
const FARTHEST_CELL: f64 = (1 << 20) as f64;

/// The length of a vector.
fn norm<const N: usize>(components: [f64; N]) -> f64 {
    components.into_iter().fold(0.0, f64::hypot)
}

/// The most of |y ln y| for y in [0, most].
fn most_of_entropy(most: f64) -> f64 {
    let peak = (-1.0_f64).exp();
    let at_most = times(most, most.ln().abs());
    if most < peak {
        at_most
    } else {
        peak.max(at_most)
    }
}

/// Which way a comparison goes, where an interval says.
fn is_less(a: Interval, b: Interval) -> Option<bool> {
    (a.hi < b.lo || a.lo >= b.hi).then_some(a.hi < b.lo)
}

impl Rounded {
    /// The length of a vector, as the root of the sum of the squares from first to last: its slope is 1. Relative errors:
    /// one rounding of each square, one of each sum, which the root halves, and its own.
    fn length<const N: usize>(range: Interval, parts: [Self; N]) -> Self {
        if parts.iter().any(Self::is_lost) {
            return Self::lost(range);
        }
        let squares = parts.map(|x| rounded(x.computed.square()));
        let sum = squares
            .into_iter()
            .reduce(|sum, square| rounded(sum + square));
        let sum = sum.unwrap_or(Interval::point(0.0));
        if !is_in_reach(sum) {
            return Self::lost(range);
        }
        let computed = rounded(sum.sqrt());
        let roundings = 0.5 * N as f64 + 1.01;
        let error = norm(parts.map(|x| x.error)) + roundings * UNIT * computed.magnitude();
        Self::of(range, computed, error + LEAST_LENGTH)
    }

    /// The angle whose sine or cosine is `self`: of two numbers with a given difference those next to 1 have angles that
    /// differ most, by `2 asin sqrt(e / 2) <= pi sqrt(e / 2)`.
    fn arc(self, arc: fn(Interval) -> Interval) -> Self {
        let range = arc(self.range);
        if self.is_lost() || self.computed.magnitude() > 1.0 {
            return Self::lost(range);
        }
        let computed = arc(self.computed);
        let least = self.hull().cathetus().lo.max(0.0);
        let moved = (self.error / least).min(PI * FRAC_1_SQRT_2 * self.error.sqrt());
        let rounding = kernel_error(computed, 5.0);
        Self::of(range, wider(computed, rounding), moved + rounding)
    }

    /// By how much the square root of exact and computed values can differ that differ by `error`, where the roots are at
    /// least these: by `error / (p + q)`, and never by more than `sqrt(error)`.
    fn root_error(error: f64, roots: [Interval; 2]) -> f64 {
        let [p, q] = roots.map(|root| root.lo.max(0.0));
        (error / (p + q)).min(error.sqrt())
    }

    /// `self^e` for a positive exponent. In `f32` it is off by the share `4 u + 5 u |ln y|` of its value y (2 ulp of the
    /// exponential; two of the logarithm and one rounding of the product, times its exponent).
    fn positive_power(self, e: Self) -> Self {
        let range = self.range.pow(e.range);
        let computed = self.computed.pow(e.computed);
        let most = self.hull().pow(e.hull()).magnitude();
        let entropy = most_of_entropy(most);
        let rounding = UNIT * (4.1 * most + 5.5 * entropy) + LEAST;
        let by_exponent = times(e.error, entropy / e.hull().lo);
        let moved = self.base_error(e.hull()) + by_exponent;
        let computed = common(wider(computed, rounding), NOT_NEGATIVE);
        Self::of(range, computed, moved + rounding)
    }

    /// By how much `self^p` changes with the error of `self`, for one and the same positive p of an interval: its slope
    /// p x^(p - 1) is largest at an end of x and an end of p; for p below 1 it is infinite at 0, and the change at most
    /// the power of the error.
    fn base_error(&self, p: Interval) -> f64 {
        let x = self.hull();
        let ends = [x.lo.max(0.0), x.hi];
        let slopes = ends.map(|x| {
            let [low, high] = [p.lo, p.hi].map(|p| libm::pow(x, p - 1.0));
            p.hi * low.max(high)
        });
        let by_slope = times(self.error, slopes[0].max(slopes[1]));
        if p.hi <= 1.0 {
            let [low, high] = [p.lo, p.hi].map(|p| libm::pow(self.error, p));
            return by_slope.min(low.max(high));
        }
        by_slope
    }
}

impl Number for Rounded {
    type Constant = f64;

    const HAS_ERRORS: bool = true;

    /// What is infinite in `f32` is no number to compute with, but `min` and `max` pass over it.
    fn constant(x: f64) -> f64 {
        x
    }

    fn spread(x: f64) -> Self {
        let (range, computed) = (Interval::point(x), Interval::point(f64::from(x as f32)));
        if !is_in_reach(computed) {
            return Self {
                computed,
                ..Self::lost(range)
            };
        }
        Self::of(range, computed, apart(range, computed))
    }

    /// One that is lost says nothing about the upper end: NaN is passed over.
    fn min(self, o: Self) -> Self {
        let is_below =
            |a: &Self, b: &Self| a.range.hi <= b.range.lo && a.computed.hi <= b.computed.lo;
        if !self.is_lost() && is_below(&self, &o) {
            return self;
        }
        if !o.is_lost() && is_below(&o, &self) {
            return o;
        }
        let range = self.range.min(o.range);
        let computed = self.computed.min(o.computed);
        if !is_in_reach(computed) {
            return Self {
                computed,
                ..Self::lost(range)
            };
        }
        Self::of(range, computed, self.error.max(o.error))
    }

    fn max(self, o: Self) -> Self {
        -(-self).min(-o)
    }

    fn abs(self) -> Self {
        let range = self.range.abs();
        if self.is_lost() {
            return Self::lost(range);
        }
        Self::of(range, self.computed.abs(), self.error)
    }

    fn sqrt(self) -> Self {
        let range = self.range.sqrt();
        if self.is_lost() || self.computed.lo < 0.0 {
            return Self::lost(range);
        }
        let root = self.computed.sqrt();
        let moved = Self::root_error(self.error, [range, root]);
        Self::of(range, rounded(root), moved + UNIT * root.magnitude())
    }

    /// Exact but for steps between the exact and the computed value.
    fn floor(self) -> Self {
        let range = self.range.floor();
        if self.is_lost() {
            return Self::lost(range);
        }
        Self::of(range, self.computed.floor(), self.error.ceil())
    }

    fn sin(self) -> Self {
        self.one(Number::sin, Number::sin, 2.0)
    }

    fn cos(self) -> Self {
        self.one(Number::cos, Number::cos, 2.0)
    }

    /// The slope is 1 by the distance from the origin; across the negative x axis the angle jumps.
    fn atan2(self, x: Self) -> Self {
        let range = self.range.atan2(x.range);
        if self.is_lost() || x.is_lost() {
            return Self::lost(range);
        }
        let computed = self.computed.atan2(x.computed);
        let (up, along) = (self.hull(), x.hull());
        let nearest = norm([up.mignitude(), along.mignitude()]) * (1.0 - 1e-15);
        let crosses = along.lo < 0.0 && up.lo < 0.0 && up.hi >= 0.0;
        let moved = match norm([self.error, x.error]) {
            0.0 => 0.0,
            _ if crosses => f64::INFINITY,
            error => error / nearest,
        };
        let rounding = kernel_error(computed, 2.0);
        Self::of(range, wider(computed, rounding), moved + rounding)
    }

    fn exp(self) -> Self {
        let mut y = self.one(Number::exp, Number::exp, 2.0);
        if !y.is_lost() {
            y.computed = common(y.computed, NOT_NEGATIVE);
        }
        y
    }

    fn ln(self) -> Self {
        self.one(Number::ln, Number::ln, 2.0)
    }

    /// Where the comparison may go one way for the exact and the other way for the computed numbers, the branches may
    /// differ by all that their ranges allow.
    fn select_lt(a: Self, b: Self, x: Self, y: Self) -> Self {
        let decided = is_less(a.range, b.range);
        if decided.is_some() && decided == is_less(a.computed, b.computed) {
            return if decided == Some(true) { x } else { y };
        }
        let range = Interval::select_lt(a.range, b.range, x.range, y.range);
        let computed = Interval::select_lt(a.computed, b.computed, x.computed, y.computed);
        let is_same = a.error == 0.0 && b.error == 0.0;
        let jump = if is_same {
            0.0
        } else {
            apart(x.range, y.range)
        };
        Self::of(range, computed, x.error.max(y.error) + jump)
    }

    fn square(self) -> Self {
        let range = self.range.square();
        if self.is_lost() {
            return Self::lost(range);
        }
        let square = self.computed.square();
        let sum = self.range.magnitude() + self.computed.magnitude();
        let error = times(self.error, sum) + UNIT * square.magnitude() + LEAST;
        Self::of(range, rounded(square), error)
    }

    /// The errors of the ends are mixed too; the share's counts by how far the ends are apart. Roundings: one of the
    /// difference, one of the product, one of the sum.
    fn mix(self, a: Self, b: Self) -> Self {
        let range = self.range.mix(a.range, b.range);
        if [self, a, b].iter().any(Self::is_lost) {
            return Self::lost(range);
        }
        let computed = self.computed.mix(a.computed, b.computed);
        let of_ends = |t: f64| times((1.0 - t).abs(), a.error) + times(t.abs(), b.error);
        let ends = of_ends(self.computed.lo).max(of_ends(self.computed.hi));
        let moved = ends + times((b.range - a.range).magnitude(), self.error);
        let product = (b.computed - a.computed).magnitude() * self.computed.magnitude();
        let rounding = UNIT * (2.01 * product + computed.magnitude()) + LEAST;
        if !is_in_reach(Interval::point(product)) {
            return Self::lost(range);
        }
        Self::of(range, wider(computed, rounding), moved + rounding)
    }

    /// Roundings of t^2 (3 - t - t): three of the whole, and one of 3 - t.
    fn ease(self) -> Self {
        let plain = self.one(Number::ease, Number::ease, 1.6);
        if plain.is_lost() {
            return plain;
        }
        let rest = (Interval::point(3.0) - self.computed).magnitude();
        let more = 1.01 * UNIT * self.computed.square().magnitude() * rest + 4.0 * LEAST;
        Self::of(plain.range, wider(plain.computed, more), plain.error + more)
    }

    fn hypot(self, o: Self) -> Self {
        Self::length(self.range.hypot(o.range), [self, o])
    }

    fn norm3(x: Self, y: Self, z: Self) -> Self {
        Self::length(Interval::norm3(x.range, y.range, z.range), [x, y, z])
    }

    /// As a quotient that is at most 1; where squares underflow, a computed length may be less than its component by a
    /// fifth.
    fn direction_cosine(self, length: Self) -> Self {
        let range = self.range.direction_cosine(length.range);
        if self.is_lost() || length.is_lost() {
            return Self::lost(range);
        }
        let limit = Interval::new(-1.25, 1.25);
        let least = length.computed.lo;
        if least <= 0.0 {
            return Self::of(range, limit, f64::INFINITY);
        }
        let computed = common(limit, rounded(self.computed / length.computed));
        let moved = (self.error + length.error) / least;
        let rounding = UNIT * computed.magnitude() + LEAST;
        Self::of(range, computed, moved + rounding)
    }

    fn pow(self, e: Self) -> Self {
        let is_known = !self.is_lost() && !e.is_lost();
        if is_known && self.computed.lo >= 0.0 && self.range.lo >= 0.0 && e.hull().lo > 0.0 {
            return self.positive_power(e);
        }
        let (zero, one) = (Self::splat(0.0), Self::splat(1.0));
        let general = (e * self.ln()).exp();
        Self::select_lt(zero, e.abs(), general, one + e)
    }

    fn powi(self, n: i32) -> Self {
        if n == 0 {
            return Self::splat(1.0);
        }
        let ulps = f64::from(n.unsigned_abs()) + 1.0;
        self.one(|x| x.powi(n), |x| x.powi(n), ulps)
    }

    fn tan(self) -> Self {
        self.one(Number::tan, Number::tan, 5.0)
    }

    fn asin(self) -> Self {
        self.arc(Number::asin)
    }

    fn acos(self) -> Self {
        self.arc(Number::acos)
    }

    /// The root of `1 - x^2`, with the roundings of both factors, of their product and of the root.
    fn cathetus(self) -> Self {
        let range = self.range.cathetus();
        if self.is_lost() || self.computed.magnitude() > 1.0 {
            return Self::lost(range);
        }
        let computed = self.computed.cathetus();
        let sum = self.range.magnitude() + self.computed.magnitude();
        let moved = Self::root_error(times(self.error, sum), [range, computed]);
        let rounding = kernel_error(computed, 1.3);
        let wide = common(wider(computed, rounding), NOT_NEGATIVE);
        Self::of(range, wide, moved + rounding)
    }

    /// The slope over all that lies between, times the length of the errors.
    fn lattice(lattice: Lattice, x: Self, y: Self, z: Self) -> Self {
        let range = Interval::lattice(lattice, x.range, y.range, z.range);
        let [u, v, w] = [x, y, z].map(|c| c.hull());
        if [u, v, w].iter().any(|c| c.magnitude() > FARTHEST_CELL) {
            return Self::lost(range);
        }
        let slope = norm(Interval::lattice_slope(lattice, u, v, w).map(Interval::magnitude));
        let moved = slope.min(lattice.lipschitz()) * norm([x.error, y.error, z.error]);
        let error = moved + lattice.roundings() * UNIT;
        Self::of(range, wider(range, error), error)
    }

    fn fract(self) -> Self {
        let range = self.range.fract();
        let plain = self - self.floor();
        if plain.is_lost() {
            return Self::lost(range);
        }
        let computed = common(plain.computed, Interval::new(0.0, 1.0));
        Self::of(range, computed, plain.error)
    }

    fn computed_alone(self) -> Self {
        Rounded::computed_alone(self)
    }

    /// With f for the function, g for what `f32` makes of it, (a, b) exact and (c, d) computed numbers:
    /// `|g(c, d) - f(a, b)| <= |g(c, d) - f(c, d)| + |f(c, d) - f(a, b)|`, the error of `alone` and the change of f.
    fn with_slope(self, alone: Self, change: impl Fn([f64; 2]) -> f64, of: [Self; 2]) -> Self {
        if alone.is_lost() {
            return self;
        }
        let moved = change(of.map(|x| x.error));
        let computed = common(self.computed, alone.computed);
        Self::of(self.range, computed, self.error.min(moved + alone.error))
    }
}
