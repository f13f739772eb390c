//! Scalars: f64 and f32, with elementary functions that give the same bits on every machine and in every lane.

use super::float::Float;
use super::{Number, kernels};

macro_rules! scalar {
    ($type:ty) => {
        impl Number for $type {
            type Constant = Self;

            const LEAVES_OUT: bool = true;

            #[inline(always)]
            fn may_be_below(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn constant(x: f64) -> Self {
                x as $type
            }
            #[inline(always)]
            fn spread(x: Self) -> Self {
                x
            }
            #[inline(always)]
            fn min(self, o: Self) -> Self {
                kernels::min(self, o)
            }
            #[inline(always)]
            fn max(self, o: Self) -> Self {
                kernels::max(self, o)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                Float::abs(self)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                Float::sqrt(self)
            }
            #[inline(always)]
            fn floor(self) -> Self {
                kernels::floor(self)
            }
            #[inline(always)]
            fn sin(self) -> Self {
                kernels::sin(self)
            }
            #[inline(always)]
            fn cos(self) -> Self {
                kernels::cos(self)
            }
            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                kernels::sin_cos(self)
            }
            #[inline(always)]
            fn atan2(self, x: Self) -> Self {
                kernels::atan2(self, x)
            }
            #[inline(always)]
            fn exp(self) -> Self {
                kernels::exp(self)
            }
            #[inline(always)]
            fn ln(self) -> Self {
                kernels::ln(self)
            }
            #[inline(always)]
            fn select_lt(a: Self, b: Self, x: Self, y: Self) -> Self {
                if a < b { x } else { y }
            }
        }
    };
}

scalar!(f64);
scalar!(f32);
