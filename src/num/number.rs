//! The one trait behind every distance function.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number that a field can be evaluated over.
///
/// Functions over `Number` are free of branches: what depends on a comparison is written with [`Number::min`],
/// [`Number::max`] and [`Number::select_lt`], so that one call serves a scalar, a packet of lanes, a dual number or a
/// whole interval. Angles are in radians.
pub trait Number:
    Copy
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The constant `x` (rounded to the type; in an interval, an interval that contains `x`).
    fn splat(x: f64) -> Self;

    /// The smaller of two; a NaN operand is passed over where the other is a number.
    fn min(self, other: Self) -> Self;

    /// The larger of two; a NaN operand is passed over where the other is a number.
    fn max(self, other: Self) -> Self;

    /// The absolute value; the derivative at 0 is that of the positive side.
    fn abs(self) -> Self;

    /// The square root, NaN below zero; the derivative at 0 is defined as 0 (else `sqrt(max(q, 0)^2)` has none).
    fn sqrt(self) -> Self;

    /// The largest whole number not above.
    fn floor(self) -> Self;

    /// The sine.
    fn sin(self) -> Self;

    /// The cosine.
    fn cos(self) -> Self;

    /// The angle of the point `(x, self)` from the x axis, in (-pi, pi]; 0 at the origin.
    fn atan2(self, x: Self) -> Self;

    /// The exponential function.
    fn exp(self) -> Self;

    /// The natural logarithm, NaN below zero.
    fn ln(self) -> Self;

    /// `x` where `a < b`, else `y` (also where the comparison is undefined).
    fn select_lt(a: Self, b: Self, x: Self, y: Self) -> Self;

    /// What [`Number::select_lt`] means for the derivatives `x` and `y` of its branches. Where an interval cannot
    /// decide the comparison, the function may jump, so the derivative is unbounded.
    #[inline(always)]
    fn select_lt_slope(a: Self, b: Self, x: Self, y: Self) -> Self {
        Self::select_lt(a, b, x, y)
    }

    /// The derivative of [`Number::floor`] at `self`: 0, or unbounded where an interval holds a step.
    #[inline(always)]
    fn floor_slope(self) -> Self {
        Self::splat(0.0)
    }

    /// `self` held between `low` and `high`.
    #[inline(always)]
    fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }

    /// The square, which is never negative (tighter than `self * self` in an interval).
    #[inline(always)]
    fn square(self) -> Self {
        self * self
    }

    /// `sqrt(self^2 + other^2)`; the derivative at the origin is defined as 0.
    #[inline(always)]
    fn hypot(self, other: Self) -> Self {
        (self.square() + other.square()).sqrt()
    }

    /// The length of the vector `(x, y, z)`; the derivative at the origin is defined as 0.
    #[inline(always)]
    fn norm3(x: Self, y: Self, z: Self) -> Self {
        (x.square() + y.square() + z.square()).sqrt()
    }

    /// `self / length` for a component of a vector of that length: within [-1, 1], and 0 where the length is 0.
    #[inline(always)]
    fn direction_cosine(self, length: Self) -> Self {
        let zero = Self::splat(0.0);
        Self::select_lt(zero, length, self / length, zero)
    }

    /// `self` to the power `e`, by `exp(e ln(self))`: NaN below zero, 0 at 0 for `e > 0`, 1 for `e = 0`.
    #[inline(always)]
    fn pow(self, e: Self) -> Self {
        let zero = Self::splat(0.0);
        let general = (e * self.ln()).exp();
        // ln(0) is -inf, and -inf * 0 has no value; x^0 is 1 for every x.
        let at_zero = Self::select_lt(zero, e.abs(), zero, Self::splat(1.0));
        let positive = Self::select_lt(zero, self, general, at_zero);
        Self::select_lt(
            self,
            zero,
            Self::select_lt(zero, e.abs(), general, Self::splat(1.0)),
            positive,
        )
    }
}
