//! Lanes: many scalars that go through the same operations at once.
//!
//! Plain arrays with plain loops: inside a function compiled for AVX2 or AVX-512 the loops become instructions of that
//! width, because every operation is inlined into its caller. No operation may do without `#[inline(always)]`.

use super::float::Float;
use super::{Number, kernels};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `W` numbers of type `T` (`f32` or `f64`), each with the bits that the scalar operations give.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes<T, const W: usize>(pub [T; W]);

/// 64 single precision lanes: four AVX-512 registers.
pub type F32x64 = Lanes<f32, 64>;

/// 32 double precision lanes: four AVX-512 registers.
pub type F64x32 = Lanes<f64, 32>;

/// The lanes whose lane `$i` is `$value`. A loop in place, because a closure might fall out of the feature region.
macro_rules! each {
    ($i:ident => $value:expr) => {{
        let mut out = [T::ZERO; W];
        for $i in 0..W {
            out[$i] = $value;
        }
        Self(out)
    }};
}

impl<T: Float, const W: usize> Lanes<T, W> {
    /// The lanes whose lane `i` is `f(i)`.
    #[inline(always)]
    pub fn from_fn(f: impl Fn(usize) -> T) -> Self {
        each!(i => f(i))
    }

    /// Whether some lane is out of the reach of the trigonometric kernels.
    #[inline(always)]
    fn is_beyond_trig(self) -> bool {
        let mut beyond = false;
        for i in 0..W {
            beyond |= kernels::is_beyond_trig(self.0[i]);
        }
        beyond
    }
}

/// `near`, with the lanes that the kernel does not reach taken from `anywhere`. Rare, so it may leave the feature region.
#[cold]
#[inline(never)]
fn with_far_lanes<T: Float, const W: usize>(
    x: Lanes<T, W>,
    near: Lanes<T, W>,
    anywhere: fn(T) -> T,
) -> Lanes<T, W> {
    let mut out = near;
    for (out, x) in out.0.iter_mut().zip(x.0) {
        if kernels::is_beyond_trig(x) {
            *out = anywhere(x);
        }
    }
    out
}

impl<T: Float, const W: usize> Add for Lanes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        each!(i => self.0[i] + o.0[i])
    }
}

impl<T: Float, const W: usize> Sub for Lanes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        each!(i => self.0[i] - o.0[i])
    }
}

impl<T: Float, const W: usize> Mul for Lanes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        each!(i => self.0[i] * o.0[i])
    }
}

impl<T: Float, const W: usize> Div for Lanes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        each!(i => self.0[i] / o.0[i])
    }
}

impl<T: Float, const W: usize> Neg for Lanes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        each!(i => -self.0[i])
    }
}

impl<T: Float, const W: usize> Number for Lanes<T, W> {
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self([T::from_f64(x); W])
    }

    #[inline(always)]
    fn min(self, o: Self) -> Self {
        each!(i => kernels::min(self.0[i], o.0[i]))
    }

    #[inline(always)]
    fn max(self, o: Self) -> Self {
        each!(i => kernels::max(self.0[i], o.0[i]))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        each!(i => self.0[i].abs())
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        each!(i => self.0[i].sqrt())
    }

    #[inline(always)]
    fn floor(self) -> Self {
        each!(i => kernels::floor(self.0[i]))
    }

    #[inline(always)]
    fn sin(self) -> Self {
        let near = each!(i => kernels::sin_near(self.0[i]));
        if self.is_beyond_trig() {
            return with_far_lanes(self, near, T::sin_anywhere);
        }
        near
    }

    #[inline(always)]
    fn cos(self) -> Self {
        let near = each!(i => kernels::cos_near(self.0[i]));
        if self.is_beyond_trig() {
            return with_far_lanes(self, near, T::cos_anywhere);
        }
        near
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        each!(i => kernels::atan2(self.0[i], x.0[i]))
    }

    #[inline(always)]
    fn exp(self) -> Self {
        each!(i => kernels::exp(self.0[i]))
    }

    #[inline(always)]
    fn ln(self) -> Self {
        each!(i => kernels::ln(self.0[i]))
    }

    #[inline(always)]
    fn select_lt(a: Self, b: Self, x: Self, y: Self) -> Self {
        each!(i => if a.0[i] < b.0[i] { x.0[i] } else { y.0[i] })
    }
}
