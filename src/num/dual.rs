//! Dual numbers: a value with its exact partial derivatives.

#![allow(
    clippy::suspicious_arithmetic_impl,
    reason = "the rules of differentiation mix operators"
)]

use super::Number;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value and its derivatives with respect to `K` variables (forward automatic differentiation).
///
/// Over `f64` it gives gradients, hence normals; over an interval it gives the range of the gradient, hence Lipschitz
/// bounds. At a kink (`abs`, `min`, `max`) the derivative is that of one side; `sqrt` has derivative 0 at 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<N, const K: usize> {
    /// The value.
    pub value: N,
    /// The partial derivatives.
    pub partial: [N; K],
}

impl<N: Number, const K: usize> Dual<N, K> {
    /// The value `value` with derivatives `partial`.
    #[inline(always)]
    pub fn new(value: N, partial: [N; K]) -> Self {
        Self { value, partial }
    }

    /// The variable number `index` at `value`: its derivative by itself is 1.
    #[inline(always)]
    pub fn variable(value: N, index: usize) -> Self {
        let mut partial = [N::splat(0.0); K];
        partial[index] = N::splat(1.0);
        Self { value, partial }
    }

    /// `value` with every derivative scaled by `slope`: the chain rule.
    #[inline(always)]
    fn chain(self, value: N, slope: N) -> Self {
        let mut partial = self.partial;
        for d in &mut partial {
            *d = *d * slope;
        }
        Self { value, partial }
    }

    /// `value` with every derivative divided by `divisor`; 0 where the divisor is 0, not 0 / 0.
    #[inline(always)]
    fn chain_over(self, value: N, divisor: N) -> Self {
        let zero = N::splat(0.0);
        let slope = N::splat(1.0) / divisor;
        let mut partial = self.partial;
        for d in &mut partial {
            *d = N::select_lt(zero, divisor, *d * slope, zero);
        }
        Self { value, partial }
    }

    /// `value`, with derivatives combined pairwise by `f`.
    #[inline(always)]
    fn zip(self, other: Self, value: N, f: impl Fn(N, N) -> N) -> Self {
        let mut partial = self.partial;
        for (d, e) in partial.iter_mut().zip(other.partial) {
            *d = f(*d, e);
        }
        Self { value, partial }
    }
}

impl<N: Number, const K: usize> Add for Dual<N, K> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        self.zip(o, self.value + o.value, |a, b| a + b)
    }
}

impl<N: Number, const K: usize> Sub for Dual<N, K> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        self.zip(o, self.value - o.value, |a, b| a - b)
    }
}

impl<N: Number, const K: usize> Mul for Dual<N, K> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        self.zip(o, self.value * o.value, |a, b| a * o.value + self.value * b)
    }
}

impl<N: Number, const K: usize> Div for Dual<N, K> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let quotient = self.value / o.value;
        self.zip(o, quotient, |a, b| (a - quotient * b) / o.value)
    }
}

impl<N: Number, const K: usize> Neg for Dual<N, K> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let mut partial = self.partial;
        for d in &mut partial {
            *d = -*d;
        }
        Self::new(-self.value, partial)
    }
}

impl<N: Number, const K: usize> Number for Dual<N, K> {
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self {
            value: N::splat(x),
            partial: [N::splat(0.0); K],
        }
    }

    #[inline(always)]
    fn min(self, o: Self) -> Self {
        // Continuous in both branches, so an undecided interval takes the hull of the slopes, not everything.
        self.zip(o, self.value.min(o.value), |a, b| {
            N::select_lt(o.value, self.value, b, a)
        })
    }

    #[inline(always)]
    fn max(self, o: Self) -> Self {
        self.zip(o, self.value.max(o.value), |a, b| {
            N::select_lt(self.value, o.value, b, a)
        })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let sign = N::select_lt(self.value, N::splat(0.0), N::splat(-1.0), N::splat(1.0));
        self.chain(self.value.abs(), sign)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain_over(root, root + root)
    }

    #[inline(always)]
    fn floor(self) -> Self {
        self.chain(self.value.floor(), self.value.floor_slope())
    }

    #[inline(always)]
    fn sin(self) -> Self {
        self.chain(self.value.sin(), self.value.cos())
    }

    #[inline(always)]
    fn cos(self) -> Self {
        self.chain(self.value.cos(), -self.value.sin())
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let scale = self.value.square() + x.value.square();
        let zero = N::splat(0.0);
        self.zip(x, self.value.atan2(x.value), |dy, dx| {
            let slope = (x.value * dy - self.value * dx) / scale;
            self.value
                .atan2_slope(x.value, N::select_lt(zero, scale, slope, zero))
        })
    }

    #[inline(always)]
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.chain(value, value)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        self.chain(self.value.ln(), N::splat(1.0) / self.value)
    }

    #[inline(always)]
    fn select_lt(a: Self, b: Self, x: Self, y: Self) -> Self {
        let value = N::select_lt(a.value, b.value, x.value, y.value);
        x.zip(y, value, |dx, dy| {
            N::select_lt_slope(a.value, b.value, dx, dy)
        })
    }

    #[inline(always)]
    fn hypot(self, o: Self) -> Self {
        let length = self.value.hypot(o.value);
        let (u, v) = (
            self.value.direction_cosine(length),
            o.value.direction_cosine(length),
        );
        self.zip(o, length, |a, b| u * a + v * b)
    }

    #[inline(always)]
    fn norm3(x: Self, y: Self, z: Self) -> Self {
        let length = N::norm3(x.value, y.value, z.value);
        let u = x.value.direction_cosine(length);
        let v = y.value.direction_cosine(length);
        let w = z.value.direction_cosine(length);
        let mut partial = x.partial;
        for (d, (b, c)) in partial.iter_mut().zip(y.partial.into_iter().zip(z.partial)) {
            *d = u * *d + v * b + w * c;
        }
        Self {
            value: length,
            partial,
        }
    }

    #[inline(always)]
    fn square(self) -> Self {
        self.chain(self.value.square(), self.value + self.value)
    }
    /// Where the derivative by the base is infinite (a root at 0) it is defined as 0.
    #[inline(always)]
    fn pow(self, e: Self) -> Self {
        let (zero, infinity) = (N::splat(0.0), N::splat(f64::INFINITY));
        let value = self.value.pow(e.value);
        let slope = e.value * self.value.pow(e.value - N::splat(1.0));
        let growth = N::select_lt(zero, self.value, value * self.value.ln(), zero);
        self.zip(e, value, |dx, de| {
            N::select_lt(slope.abs(), infinity, slope * dx, zero) + growth * de
        })
    }

    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        if n == 0 {
            return Self::splat(1.0);
        }
        let slope = N::splat(n.into()) * self.value.powi(n.saturating_sub(1));
        self.chain(self.value.powi(n), slope)
    }

    #[inline(always)]
    fn tan(self) -> Self {
        let value = self.value.tan();
        self.chain(value, N::splat(1.0) + value.square())
    }

    #[inline(always)]
    fn asin(self) -> Self {
        self.chain_over(self.value.asin(), self.value.cathetus())
    }

    #[inline(always)]
    fn acos(self) -> Self {
        -self.chain_over(-self.value.acos(), self.value.cathetus())
    }
}
