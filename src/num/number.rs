//! The one trait behind every distance function.

use super::{Lattice, lattice};
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
    /// Whether the numbers carry bounds of their errors. Then [`Number::with_slope`] says more than the operations that a
    /// function is made of.
    const HAS_ERRORS: bool = false;

    /// Whether the numbers carry bounds of second derivatives. Then [`Number::with_curvature`] and
    /// [`Number::with_convexity`] say more than the operations that a function is made of.
    const HAS_BENDS: bool = false;

    /// How many lanes there are; 1 where there are none, and of numbers made of others.
    const LANES: usize = 1;

    /// Whether [`Number::may_be_below`] says anything. Then what has no say may be left out.
    const LEAVES_OUT: bool = false;

    /// What a constant is kept as where it is used again and again: of lanes one of them.
    type Constant: Copy + Send + Sync + 'static;

    /// `x` as it is kept.
    fn constant(x: f64) -> Self::Constant;

    /// What was kept, as a number (rounded to the type; in an interval, an interval that contains it).
    fn spread(constant: Self::Constant) -> Self;

    /// The constant `x` (rounded to the type; in an interval, an interval that contains `x`).
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self::spread(Self::constant(x))
    }

    /// The smaller of two; a NaN operand is passed over where the other is a number; of two equals (two zeros) the second.
    fn min(self, other: Self) -> Self;

    /// The larger of two; a NaN operand is passed over where the other is a number; of two equals (two zeros) the second.
    fn max(self, other: Self) -> Self;

    /// The absolute value; the derivative at 0 is that of the positive side.
    fn abs(self) -> Self;

    /// The square root, NaN below zero; the derivative at 0 is defined as 0 (else `sqrt(max(q, 0)^2)` has none).
    fn sqrt(self) -> Self;

    /// The largest whole number not above.
    fn floor(self) -> Self;

    /// The sine, off by at most 2 ulp however far the angle; NaN at infinities.
    fn sin(self) -> Self;

    /// The cosine, off by at most 2 ulp however far the angle; NaN at infinities.
    fn cos(self) -> Self;

    /// The sine and the cosine, each as it is alone: for lanes in little more than the time of one of them.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        (self.sin(), self.cos())
    }

    /// The angle of the point `(x, self)` from the x axis, in (-pi, pi], off by at most 2 ulp; 0 at the origin. The
    /// sign of a zero has no say: on the negative x axis the angle is pi.
    fn atan2(self, x: Self) -> Self;

    /// The exponential function, off by at most 2 ulp.
    fn exp(self) -> Self;

    /// The natural logarithm, off by at most 2 ulp; -infinity at 0, NaN below.
    fn ln(self) -> Self;

    /// `x` where `a < b`, else `y` (also where the comparison is undefined).
    fn select_lt(a: Self, b: Self, x: Self, y: Self) -> Self;

    /// Whether `self < other` may hold, in any lane; always, where that is not known.
    #[inline(always)]
    fn may_be_below(self, _other: Self) -> bool {
        true
    }

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

    /// What [`Number::atan2`] means for its derivative `slope` at the point `(x, self)`: unbounded where an interval
    /// crosses the negative x axis, where the angle jumps.
    #[inline(always)]
    fn atan2_slope(self, _x: Self, slope: Self) -> Self {
        slope
    }

    /// `self` held between `low` and `high`.
    #[inline(always)]
    fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }

    /// `a` for `self = 0`, `b` for `self = 1`, straight between: `a + (b - a) self`. An interval within [0, 1] gives no
    /// more than lies between.
    #[inline(always)]
    fn mix(self, a: Self, b: Self) -> Self {
        a + (b - a) * self
    }

    /// The cubic `t^2 (3 - 2 t)` that rises smoothly from 0 at `t = 0` to 1 at `t = 1`; meant for `self` in [0, 1].
    #[inline(always)]
    fn ease(self) -> Self {
        self.square() * (Self::splat(3.0) - self - self)
    }

    /// [`Number::ease`] of `self` held within [0, 1]: its slope has no jump at the ends.
    #[inline(always)]
    fn smoothstep(self) -> Self {
        self.clamp(Self::splat(0.0), Self::splat(1.0)).ease()
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

    /// `self` to the power `e`, by `exp(e ln(self))`: NaN below zero; at zero 0, 1 or infinity as `e` is positive, 0 or
    /// negative. Off by at most `2 + 3 |e ln(self)|` ulp, in subnormal results too; 0 and infinity where it underflows and
    /// overflows. Unlike C's, 1 to an infinite power is NaN.
    #[inline(always)]
    fn pow(self, e: Self) -> Self {
        let general = (e * self.ln()).exp();
        // e ln(x) has no value at e = 0, x = 0; x^0 is 1 for every x. An e that is not a number stays so.
        let at_zero = Self::splat(1.0) + e;
        Self::select_lt(Self::splat(0.0), e.abs(), general, at_zero)
    }

    /// `self` to the whole power `n`, by repeated squaring; 1 for `n = 0`. Off by at most `|n|` ulp (one more for
    /// negative `n`).
    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        let power = whole_power(self, n.unsigned_abs());
        if n < 0 {
            Self::splat(1.0) / power
        } else {
            power
        }
    }

    /// The tangent, off by at most 5 ulp.
    #[inline(always)]
    fn tan(self) -> Self {
        let (sine, cosine) = self.sin_cos();
        sine / cosine
    }

    /// The angle in [-pi/2, pi/2] with sine `self`, off by at most 5 ulp; NaN outside [-1, 1]. The derivative at the ends,
    /// where it is infinite, is defined as 0.
    #[inline(always)]
    fn asin(self) -> Self {
        self.atan2(self.cathetus())
    }

    /// The angle in [0, pi] with cosine `self`, off by at most 5 ulp; NaN outside [-1, 1]. The derivative at the ends,
    /// where it is infinite, is defined as 0.
    #[inline(always)]
    fn acos(self) -> Self {
        self.cathetus().atan2(self)
    }

    /// `sqrt(1 - self^2)`, the other side of a right triangle with hypotenuse 1, accurate also where it is small; NaN
    /// outside [-1, 1].
    #[inline(always)]
    fn cathetus(self) -> Self {
        let one = Self::splat(1.0);
        ((one - self) * (one + self)).sqrt()
    }

    /// The lattice function at the point `(x, y, z)`, off by at most [`Lattice::roundings`].
    #[inline(always)]
    fn lattice(lattice: Lattice, x: Self, y: Self, z: Self) -> Self {
        lattice::value(lattice, x, y, z)
    }

    /// The partial derivatives of the lattice function at the point `(x, y, z)`.
    #[inline(always)]
    fn lattice_slope(lattice: Lattice, x: Self, y: Self, z: Self) -> [Self; 3] {
        lattice::slope(lattice, x, y, z)
    }

    /// The numbers that are computed, as if they were exact; only for numbers with errors not the number itself.
    #[inline(always)]
    fn computed_alone(self) -> Self {
        self
    }

    /// `self`, the value of a function of the numbers `of`, which by itself changes by at most `change` of the errors of
    /// both; `alone` is its value of [`Number::computed_alone`] of both. Only for numbers with errors not the value itself.
    #[inline(always)]
    fn with_slope(self, _alone: Self, _change: impl Fn([f64; 2]) -> f64, _of: [Self; 2]) -> Self {
        self
    }

    /// `self`, a smooth minimum of the two numbers `of`: concave, with partial derivatives that are not negative and sum to
    /// 1, and bent by at most `curvature` along their difference. Only for numbers with bends not the value itself.
    #[inline(always)]
    fn with_curvature(self, _curvature: f64, _of: [Self; 2]) -> Self {
        self
    }

    /// `self`, a convex function with the Lipschitz constant 1 of the point `of`. Only for numbers with bends not the value
    /// itself.
    #[inline(always)]
    fn with_convexity<const K: usize>(self, _of: [Self; K]) -> Self {
        self
    }

    /// `self - floor(self)`, in [0, 1] (1 where a small negative number rounds to it).
    #[inline(always)]
    fn fract(self) -> Self {
        self - self.floor()
    }
}

/// `x^n` by repeated squaring, 1 for `n = 0`.
#[inline(always)]
pub(super) fn whole_power<N: Number>(x: N, n: u32) -> N {
    let (mut power, mut square, mut left) = (N::splat(1.0), x, n);
    while left > 0 {
        if left & 1 == 1 {
            power = power * square;
        }
        square = square.square();
        left >>= 1;
    }
    power
}

#[cfg(test)]
mod tests {
    use super::super::samples::Samples;
    use super::*;

    const SEED: u64 = 0x0b5e;

    #[test]
    fn whole_powers_are_within_their_bound() {
        let mut samples = Samples::new(SEED);
        for n in (-12..=12).filter(|&n| n != 0) {
            for _ in 0..10_000 {
                let x = samples.scaled(-2.0, 2.0);
                let expected = libm::pow(x, n.into());
                let ulps =
                    (x.powi(n) - expected).abs() / (expected.abs().next_up() - expected.abs());
                let bound = f64::from(n.abs()) + f64::from(u8::from(n < 0));
                assert!(ulps <= bound, "{x:e}^{n}: {ulps} ulp, seed {SEED:#x}");
            }
        }
    }

    #[test]
    fn powers_at_the_edges_are_those_documented() {
        let infinity = f64::INFINITY;
        let zero = 0.0_f64;
        assert_eq!(
            [zero.pow(2.0), zero.pow(0.0), zero.pow(-1.0)],
            [0.0, 1.0, infinity]
        );
        assert_eq!([5.0_f64.pow(0.0), (-5.0_f64).pow(0.0)], [1.0; 2]);
        assert!(
            (-1.0_f64).pow(2.0).is_nan()
                && f64::NAN.pow(2.0).is_nan()
                && 2.0_f64.pow(f64::NAN).is_nan()
        );
        assert_eq!(
            [(-2.0_f64).powi(3), 2.0_f64.powi(-2), zero.powi(0)],
            [-8.0, 0.25, 1.0]
        );
        assert!(Number::powi(1.0_f64, i32::MIN) == 1.0);
        assert!(Number::asin(1.1_f64).is_nan() && Number::acos(-1.1_f64).is_nan());
    }
}
