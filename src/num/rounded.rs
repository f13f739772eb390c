//! Ranges with rounding errors: how far a field in `f32` can be from its exact value, over a whole region.
//!
//! Every operation carries on what its operands were off by, to first order and beyond by the mean value theorem over
//! all that lies between exact and computed operands, and adds what its own rounding takes: at most `u` = 2^-24 of its
//! result for arithmetic and roots, and what `kernels` promises in units of the last place (2 u of a result) for the
//! elementary functions. Source: Higham 2002, chapter 3 (running error analysis).
//!
//! Beside the exact values the computed ones have an interval of their own. It knows what rounding cannot break: a
//! computed square is never negative, so its root exists. And no error is larger than the two intervals allow.

mod functions;
mod single;
#[cfg(test)]
mod tests;

use super::{Dual, Interval};
use single::{LEAST, SLACK, UNIT, is_in_reach, rounded};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The range of a number over a region, and how far it can be off where it is computed in `f32`, as
/// [`Lanes<f32, W>`](super::Lanes) do.
///
/// Where the error is finite, what is computed is a number: never NaN, and no infinity.
#[derive(Clone, Copy, Debug)]
pub struct Rounded {
    /// Holds every exact value.
    range: Interval,
    /// Holds every computed value; where it is `ENTIRE`, NaN too. Half-open after the `min` or `max` with such a
    /// number.
    computed: Interval,
    error: f64,
}

/// A product of bounds in which zero times infinity is zero.
fn times(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

/// What both intervals hold; the first where they hold nothing in common.
fn common(a: Interval, b: Interval) -> Interval {
    let (lo, hi) = (a.lo.max(b.lo), a.hi.min(b.hi));
    if lo <= hi { Interval { lo, hi } } else { a }
}

/// The longest way from a number of one interval to one of the other.
fn apart(a: Interval, b: Interval) -> f64 {
    (a.hi - b.lo).max(b.hi - a.lo)
}

impl Rounded {
    /// A coordinate: its exact values lie in `range`, its `f32` values are off by at most `error`, which is not NaN.
    pub fn new(range: Interval, error: f64) -> Self {
        Self::of(range, Interval::ENTIRE, error)
    }

    /// Holds every exact value over the region.
    pub fn range(&self) -> Interval {
        self.range
    }

    /// The most that the computed value can differ from the exact one; infinite where nothing can be said.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// A result off by at most `error`, of which the computed values lie in `computed` too. Nothing is known where they
    /// may overflow.
    fn of(range: Interval, computed: Interval, error: f64) -> Self {
        let error = if error.is_nan() { f64::INFINITY } else { error };
        let error = (error * SLACK).min(apart(range, computed) * SLACK);
        let near = if error > 0.0 {
            single::wider(range, error)
        } else {
            range
        };
        let computed = common(computed, near);
        if !is_in_reach(computed) {
            return Self::lost(range);
        }
        Self {
            range,
            computed,
            error,
        }
    }

    /// A result of which the computed values may be anything, NaN included.
    fn lost(range: Interval) -> Self {
        Self {
            range,
            computed: Interval::ENTIRE,
            error: f64::INFINITY,
        }
    }

    /// Whether the computed value may be anything, or not a number.
    fn is_lost(&self) -> bool {
        !is_in_reach(self.computed)
    }

    /// All that lies between exact and computed values.
    fn hull(&self) -> Interval {
        self.range.hull(self.computed)
    }

    /// Whether it is `x`, computed without error.
    fn is(&self, x: f64) -> bool {
        self.error == 0.0 && self.range == Interval { lo: x, hi: x }
    }

    /// A function of one number, over intervals and with its derivative. In `f32` it is off by at most `ulps`.
    fn one(
        self,
        value: impl Fn(Interval) -> Interval,
        dual: impl Fn(Dual<Interval, 1>) -> Dual<Interval, 1>,
        ulps: f64,
    ) -> Self {
        let range = value(self.range);
        if self.is_lost() {
            return Self::lost(range);
        }
        let computed = value(self.computed);
        let slope = match self.error {
            0.0 => 0.0,
            _ => dual(Dual::variable(self.hull(), 0)).partial[0].magnitude(),
        };
        let rounding = single::kernel_error(computed, ulps);
        let moved = times(slope, self.error);
        Self::of(range, single::wider(computed, rounding), moved + rounding)
    }

    /// The numbers that are computed, as if they were exact: what a function makes of them is off by its own rounding.
    fn computed_alone(self) -> Self {
        Self {
            range: self.computed,
            error: if self.is_lost() { f64::INFINITY } else { 0.0 },
            ..self
        }
    }
}

impl Add for Rounded {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        if o.is(0.0) {
            return self;
        }
        if self.is(0.0) {
            return o;
        }
        let range = self.range + o.range;
        if self.is_lost() || o.is_lost() {
            return Self::lost(range);
        }
        let sum = self.computed + o.computed;
        // A sum does not underflow: it is a multiple of the smallest number.
        let error = self.error + o.error + UNIT * sum.magnitude();
        Self::of(range, rounded(sum), error)
    }
}

impl Sub for Rounded {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul for Rounded {
    type Output = Self;

    /// cd - ab = (c - a) d + a (d - b) = (c - a) b + c (d - b), whichever is smaller.
    fn mul(self, o: Self) -> Self {
        if o.is(1.0) {
            return self;
        }
        if self.is(1.0) {
            return o;
        }
        let range = self.range * o.range;
        if self.is_lost() || o.is_lost() {
            return Self::lost(range);
        }
        let product = self.computed * o.computed;
        let [a, b] = [self.range, o.range].map(Interval::magnitude);
        let [c, d] = [self.computed, o.computed].map(Interval::magnitude);
        let by_a = times(self.error, d) + times(a, o.error);
        let by_c = times(self.error, b) + times(c, o.error);
        let error = by_a.min(by_c) + UNIT * product.magnitude() + LEAST;
        Self::of(range, rounded(product), error)
    }
}

impl Div for Rounded {
    type Output = Self;

    /// c / d - a / b = ((c - a) - a / b (d - b)) / d = ((c - a) - c / d (d - b)) / b, whichever is smaller.
    fn div(self, o: Self) -> Self {
        let range = self.range / o.range;
        if self.is_lost() || o.is_lost() || o.computed.contains(0.0) {
            return Self::lost(range);
        }
        let quotient = self.computed / o.computed;
        let moved = |quotient: Interval, divisor: Interval| {
            (self.error + times(quotient.magnitude(), o.error)) / divisor.mignitude()
        };
        let by_exact = moved(range, o.computed);
        let by_computed = moved(quotient, o.range);
        let error = by_exact.min(by_computed) + UNIT * quotient.magnitude() + LEAST;
        Self::of(range, rounded(quotient), error)
    }
}

impl Neg for Rounded {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            range: -self.range,
            computed: -self.computed,
            error: self.error,
        }
    }
}
