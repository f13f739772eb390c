//! Scalars: f64 and f32, with elementary functions that give the same bits on every machine.

use super::Number;

macro_rules! scalar {
    ($type:ty, $sin:path, $cos:path, $atan2:path, $exp:path, $ln:path) => {
        impl Number for $type {
            #[inline(always)]
            fn splat(x: f64) -> Self {
                x as $type
            }
            #[inline(always)]
            fn min(self, o: Self) -> Self {
                <$type>::min(self, o)
            }
            #[inline(always)]
            fn max(self, o: Self) -> Self {
                <$type>::max(self, o)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                <$type>::abs(self)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                <$type>::sqrt(self)
            }
            #[inline(always)]
            fn floor(self) -> Self {
                <$type>::floor(self)
            }
            #[inline(always)]
            fn sin(self) -> Self {
                $sin(self)
            }
            #[inline(always)]
            fn cos(self) -> Self {
                $cos(self)
            }
            #[inline(always)]
            fn atan2(self, x: Self) -> Self {
                $atan2(self, x)
            }
            #[inline(always)]
            fn exp(self) -> Self {
                $exp(self)
            }
            #[inline(always)]
            fn ln(self) -> Self {
                $ln(self)
            }
            #[inline(always)]
            fn select_lt(a: Self, b: Self, x: Self, y: Self) -> Self {
                if a < b { x } else { y }
            }
        }
    };
}

scalar!(f64, libm::sin, libm::cos, libm::atan2, libm::exp, libm::log);
scalar!(
    f32,
    libm::sinf,
    libm::cosf,
    libm::atan2f,
    libm::expf,
    libm::logf
);
