//! The two widths of floating point numbers: their bits, and the coefficients of the elementary functions.
//!
//! Sources of the coefficients: fdlibm (Sun Microsystems 1993) for `f64` and for `ln` and `atan2` in `f32`, Cephes
//! (Moshier 1992) for `sin`, `cos` and `exp` in `f32`; `exp` in `f64` is its Taylor series. Coefficients run from the
//! lowest power up.

#![allow(
    clippy::excessive_precision,
    reason = "coefficients stand as they were published"
)]

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A floating point number as the kernels see it. Comparisons and arithmetic are IEEE 754, round to nearest.
pub trait Float:
    Copy
    + Send
    + Sync
    + 'static
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// 0.
    const ZERO: Self;
    /// 1/2.
    const HALF: Self;
    /// 1.
    const ONE: Self;
    /// 2.
    const TWO: Self;
    /// Infinity.
    const INFINITY: Self;
    /// Not a number.
    const NAN: Self;
    /// The smallest normal number.
    const MIN_POSITIVE: Self;
    /// `2^m` for `m` stored mantissa bits: from here on every number is whole.
    const WHOLE: Self;
    /// `1.5 * 2^m`: adding it rounds to a whole number `k` and leaves the low bits of `k` as the low bits of the sum.
    const ROUNDER: Self;
    /// A quarter of the largest number, beyond which sums may overflow.
    const LARGE: Self;
    /// `sin` and `cos` have kernels up to this absolute value, and come from libm beyond: slower, lane by lane, with the same
    /// bits on every machine and off by less than 1 ulp.
    const TRIG_RANGE: Self;
    /// Below this `exp` is 0.
    const EXP_LOW: Self;
    /// Above this `exp` is infinite.
    const EXP_HIGH: Self;
    /// `1 / ln 2`.
    const LOG2_E: Self;
    /// The leading bits of `ln 2`; its product with an exponent is exact.
    const LN2_HIGH: Self;
    /// `ln 2 - LN2_HIGH`.
    const LN2_LOW: Self;
    /// `2^(m + 2)`, which makes a subnormal number normal.
    const SUBNORMAL_SCALE: Self;
    /// `m + 2`.
    const SUBNORMAL_SHIFT: Self;
    /// pi rounded, and what the rounding left.
    const PI: [Self; 2];
    /// pi / 2 rounded, and what the rounding left.
    const HALF_PI: [Self; 2];
    /// atan(1/2) rounded, and what the rounding left.
    const ATAN_HALF: [Self; 2];
    /// atan(1) rounded, and what the rounding left.
    const ATAN_ONE: [Self; 2];
    /// `(sin r / r - 1) / r^2` in powers of `r^2`, for `|r| <= pi/4`.
    const SIN: &'static [Self];
    /// `(cos r - 1 + r^2 / 2) / r^4` in powers of `r^2`, for `|r| <= pi/4`.
    const COS: &'static [Self];
    /// `(exp r - 1 - r) / r^2` in powers of `r`, for `|r| <= ln(2) / 2`.
    const EXP: &'static [Self];
    /// `(ln((1 + s) / (1 - s)) / s - 2) / s^2` in powers of `s^2`, for `|s| <= 0.1716`.
    const LN: &'static [Self];
    /// `(1 - atan t / t) / t^2` in powers of `t^2`, for `|t| <= 7/16`.
    const ATAN: &'static [Self];

    /// The nearest number of this width.
    fn from_f64(x: f64) -> Self;

    /// The absolute value.
    fn abs(self) -> Self;

    /// The square root, correctly rounded.
    fn sqrt(self) -> Self;

    /// The largest whole number not above; keeps the sign of zero, infinities and NaN. One instruction where the processor has
    /// one (from SSE4.1 on), a call of the library elsewhere.
    fn floor(self) -> Self;

    /// The absolute value of `self` with the sign bit of `sign`.
    fn with_sign_of(self, sign: Self) -> Self;

    /// `2^self` for a whole `self` within the normal exponents.
    fn power_of_two(self) -> Self;

    /// `(k, m)` with `self = 2^k m` and `m` in `[sqrt(1/2), sqrt 2)`, for a normal positive `self`.
    fn split_exponent(self) -> (Self, Self);

    /// `(r, ROUNDER + k)` with `self = k pi/2 + r` and `|r|` at most pi/4 (0.01 more in `f32`), for
    /// `|self| <= TRIG_RANGE`.
    fn quadrant(self) -> (Self, Self);

    /// For `self = ROUNDER + k`: whether `k` is odd.
    fn is_odd(self) -> bool;

    /// For `self = ROUNDER + k`: `x` where `k mod 4` is 0 or 1, else `-x`.
    fn orient(self, x: Self) -> Self;

    /// libm's sine, for any argument.
    fn sin_anywhere(self) -> Self;

    /// libm's cosine, for any argument.
    fn cos_anywhere(self) -> Self;
}

/// pi / 2 in two pieces of 33 bits, whose products with `k < 2^20` are exact, and a rest (fdlibm).
const HALF_PI_PIECES: [f64; 3] = [
    1.57079632673412561417,
    6.07710050630396597660e-11,
    2.02226624879595063154e-21,
];

/// pi / 2 less its first piece (fdlibm).
const HALF_PI_REST: f64 = 6.07710050650619224932e-11;

/// What the two widths write in the same words: `$m` mantissa bits, exponent bias, and the distance from bit 1 to the
/// sign bit.
macro_rules! shared {
    ($float:ident, $m:literal, $bias:literal, $sign:literal) => {
        const ZERO: Self = 0.0;
        const HALF: Self = 0.5;
        const ONE: Self = 1.0;
        const TWO: Self = 2.0;
        const INFINITY: Self = $float::INFINITY;
        const NAN: Self = $float::NAN;
        const MIN_POSITIVE: Self = $float::MIN_POSITIVE;
        const WHOLE: Self = (1_u64 << $m) as Self;
        const ROUNDER: Self = (3_u64 << ($m - 1)) as Self;
        const LARGE: Self = $float::MAX / 4.0;
        const LOG2_E: Self = std::$float::consts::LOG2_E;
        const SUBNORMAL_SCALE: Self = (1_u64 << ($m + 2)) as Self;
        const SUBNORMAL_SHIFT: Self = ($m + 2) as Self;

        #[inline(always)]
        fn from_f64(x: f64) -> Self {
            x as Self
        }

        #[inline(always)]
        fn abs(self) -> Self {
            $float::abs(self)
        }

        #[inline(always)]
        fn sqrt(self) -> Self {
            $float::sqrt(self)
        }

        #[inline(always)]
        fn floor(self) -> Self {
            $float::floor(self)
        }

        #[inline(always)]
        fn with_sign_of(self, sign: Self) -> Self {
            self.copysign(sign)
        }

        #[inline(always)]
        fn power_of_two(self) -> Self {
            let exponent = (self + Self::ROUNDER).to_bits().wrapping_add($bias);
            Self::from_bits(exponent << $m)
        }

        #[inline(always)]
        fn split_exponent(self) -> (Self, Self) {
            let low = std::$float::consts::FRAC_1_SQRT_2.to_bits();
            let bits = self.to_bits().wrapping_add(Self::ONE.to_bits() - low);
            // The biased exponent becomes the low bits of a large whole number: no integer conversion is needed.
            let biased = Self::from_bits(Self::WHOLE.to_bits() | (bits >> $m));
            let fraction = bits & ((1 << $m) - 1);
            (
                biased - (Self::WHOLE + $bias as Self),
                Self::from_bits(fraction + low),
            )
        }

        #[inline(always)]
        fn is_odd(self) -> bool {
            self.to_bits() & 1 != 0
        }

        #[inline(always)]
        fn orient(self, x: Self) -> Self {
            Self::from_bits(x.to_bits() ^ ((self.to_bits() & 2) << $sign))
        }
    };
}

impl Float for f64 {
    shared!(f64, 52, 1023, 62);

    const TRIG_RANGE: Self = 1e5;
    const EXP_LOW: Self = -746.0;
    const EXP_HIGH: Self = 710.0;
    const LN2_HIGH: Self = 6.93147180369123816490e-01;
    const LN2_LOW: Self = 1.90821492927058770002e-10;
    const PI: [Self; 2] = [std::f64::consts::PI, 1.22464679914735317723e-16];
    const HALF_PI: [Self; 2] = [std::f64::consts::FRAC_PI_2, 6.12323399573676603587e-17];
    const ATAN_HALF: [Self; 2] = [4.63647609000806093515e-01, 2.26987774529616870924e-17];
    const ATAN_ONE: [Self; 2] = [std::f64::consts::FRAC_PI_4, 3.06161699786838301793e-17];
    const SIN: &'static [Self] = &[
        -1.66666666666666324348e-01,
        8.33333333332248946124e-03,
        -1.98412698298579493134e-04,
        2.75573137070700676789e-06,
        -2.50507602534068634195e-08,
        1.58969099521155010221e-10,
    ];
    const COS: &'static [Self] = &[
        4.16666666666666019037e-02,
        -1.38888888888741095749e-03,
        2.48015872894767294178e-05,
        -2.75573143513906633035e-07,
        2.08757232129817482790e-09,
        -1.13596475577881948265e-11,
    ];
    const EXP: &'static [Self] = &[
        1.0 / 2.0,
        1.0 / 6.0,
        1.0 / 24.0,
        1.0 / 120.0,
        1.0 / 720.0,
        1.0 / 5_040.0,
        1.0 / 40_320.0,
        1.0 / 362_880.0,
        1.0 / 3_628_800.0,
        1.0 / 39_916_800.0,
        1.0 / 479_001_600.0,
        1.0 / 6_227_020_800.0,
    ];
    const LN: &'static [Self] = &[
        6.666666666666735130e-01,
        3.999999999940941908e-01,
        2.857142874366239149e-01,
        2.222219843214978396e-01,
        1.818357216161805012e-01,
        1.531383769920937332e-01,
        1.479819860511658591e-01,
    ];
    const ATAN: &'static [Self] = &[
        3.33333333333329318027e-01,
        -1.99999999998764832476e-01,
        1.42857142725034663711e-01,
        -1.11111104054623557880e-01,
        9.09088713343650656196e-02,
        -7.69187620504482999495e-02,
        6.66107313738753120669e-02,
        -5.83357013379057348645e-02,
        4.97687799461593236017e-02,
        -3.65315727442169155270e-02,
        1.62858201153657823623e-02,
    ];

    #[inline(always)]
    fn quadrant(self) -> (Self, Self) {
        let [p, q, rest] = HALF_PI_PIECES;
        let quadrant = self * std::f64::consts::FRAC_2_PI + Self::ROUNDER;
        let k = quadrant - Self::ROUNDER;
        let a = self - k * p;
        let b = a - k * q;
        let lost = (a - b) - k * q;
        (b - (k * rest - lost), quadrant)
    }

    fn sin_anywhere(self) -> Self {
        libm::sin(self)
    }

    fn cos_anywhere(self) -> Self {
        libm::cos(self)
    }
}

impl Float for f32 {
    shared!(f32, 23, 127, 30);

    const TRIG_RANGE: Self = 1e5;
    const EXP_LOW: Self = -105.0;
    const EXP_HIGH: Self = 89.0;
    const LN2_HIGH: Self = 0.693359375;
    const LN2_LOW: Self = -2.12194440e-4;
    const PI: [Self; 2] = [std::f32::consts::PI, -8.74227766e-8];
    const HALF_PI: [Self; 2] = [std::f32::consts::FRAC_PI_2, -4.37113883e-8];
    const ATAN_HALF: [Self; 2] = [4.6364760399e-01, 5.0121582440e-09];
    const ATAN_ONE: [Self; 2] = [std::f32::consts::FRAC_PI_4, -2.18556941e-8];
    const SIN: &'static [Self] = &[-1.6666654611e-1, 8.3321608736e-3, -1.9515295891e-4];
    const COS: &'static [Self] = &[
        4.166664568298827e-2,
        -1.388731625493765e-3,
        2.443315711809948e-5,
    ];
    const EXP: &'static [Self] = &[
        5.0000001201e-1,
        1.6666665459e-1,
        4.1665795894e-2,
        8.3334519073e-3,
        1.3981999507e-3,
        1.9875691500e-4,
    ];
    const LN: &'static [Self] = &[0.66666662693, 0.40000972152, 0.28498786688, 0.24279078841];
    const ATAN: &'static [Self] = &[
        3.3333328366e-01,
        -1.9999158382e-01,
        1.4253635705e-01,
        -1.0648017377e-01,
        6.1687607318e-02,
    ];

    /// Reduced in `f64`, where two pieces of pi / 2 suffice: single precision would need five.
    #[inline(always)]
    fn quadrant(self) -> (Self, Self) {
        let quadrant = self * std::f32::consts::FRAC_2_PI + Self::ROUNDER;
        let k = (quadrant - Self::ROUNDER) as f64;
        let r = (self as f64 - k * HALF_PI_PIECES[0]) - k * HALF_PI_REST;
        (r as f32, quadrant)
    }

    fn sin_anywhere(self) -> Self {
        libm::sinf(self)
    }

    fn cos_anywhere(self) -> Self {
        libm::cosf(self)
    }
}
