//! Elementary functions: short, free of branches, the same bits on every machine and in every lane.
//!
//! Each kernel is plain arithmetic without fused multiply-add, so a loop over lanes vectorises on any processor and
//! gives the bits of the scalar call. The algorithms are those of fdlibm (Sun Microsystems 1993), with selections in
//! place of its branches; the coefficients stand in [`Float`].
//!
//! Errors in units of the last place (ulp), over all arguments: subnormal numbers, both signs, up to the largest; where a
//! function overflows, infinity counts as the next number. The worst in `f32` of functions of one number is that of all 2^32
//! arguments. In `f64`, and for pairs, it is that of samples of every exponent; 1.5 means next to the correctly rounded
//! number, 2.5 one further. All are found by `tests/ulps`, against correctly rounded functions.
//!
//! | function | bound | worst in `f32` | worst in `f64` |
//! |---|---|---|---|
//! | `sin` | 2 | 1.58 at 2100.902 | 1.5 |
//! | `cos` | 2 | 1.58 at 16231.888 | 1.5 |
//! | `exp` | 2 | 0.90 at -5.1971707 | 1.5 |
//! | `ln` | 2 | 0.84 at 1.4133185 | 1.5 |
//! | `atan2` | 2 | 1.44 at (5.7499995e17, -1.4411519e17) | 1.5 |
//! | `sqrt` | 0.5 | 0.5 | 0.5 |
//! | `tan` | 5 | 3.69 at 1046.9318 | 3.5 |
//! | `asin` | 5 | 2.54 at 0.24652393 | 2.5 |
//! | `acos` | 5 | 2.26 at 0.96930593 | 2.5 |
//! | `pow` | 2 + 3 \|e ln x\| | 0.60 of it | 0.75 of it |
//! | gradient noise | 160 u | 31.3 u | 38.9 u |
//! | distance to scattered points | 16 u | 2.5 u | 2.9 u |
//!
//! The last two are absolute errors in units of u = `EPSILON / 2`, at coordinates up to 2^22 in `f32` and 2^51 in `f64`
//! ([`Lattice::roundings`](super::Lattice::roundings)); the others hold for every argument. Angles beyond 1e5 have the waves
//! of libm.

use super::float::Float;

/// `c[0] + c[1] x + c[2] x^2 + ...`.
#[inline(always)]
fn polynomial<T: Float>(c: &[T], x: T) -> T {
    let mut sum = c[c.len() - 1];
    let mut i = c.len() - 1;
    while i > 0 {
        i -= 1;
        sum = sum * x + c[i];
    }
    sum
}

/// The smaller of two: `b` if they are equal (so of two zeros the second), the other one if one is NaN.
#[inline(always)]
pub fn min<T: Float>(a: T, b: T) -> T {
    let smaller = if a < b { a } else { b };
    if is_nan(b) { a } else { smaller }
}

/// The larger of two: `b` if they are equal (so of two zeros the second), the other one if one is NaN.
#[inline(always)]
pub fn max<T: Float>(a: T, b: T) -> T {
    let larger = if a > b { a } else { b };
    if is_nan(b) { a } else { larger }
}

/// Whether `x` is not a number.
#[inline(always)]
#[allow(clippy::eq_op, reason = "only NaN differs from itself")]
fn is_nan<T: Float>(x: T) -> bool {
    x != x
}

/// The largest whole number not above `x`, exact; keeps the sign of zero, infinities and NaN.
#[inline(always)]
pub fn floor<T: Float>(x: T) -> T {
    x.floor()
}

/// Whether the kernels of sine and cosine do not reach `x`. False for NaN.
#[inline(always)]
pub fn is_beyond_trig<T: Float>(x: T) -> bool {
    x.abs() > T::TRIG_RANGE
}

/// The sine, off by at most 2 ulp: beyond `TRIG_RANGE` libm's, off by less than 1 ulp; NaN at infinities.
#[inline(always)]
pub fn sin<T: Float>(x: T) -> T {
    if is_beyond_trig(x) {
        x.sin_anywhere()
    } else {
        sin_near(x)
    }
}

/// The cosine, off by at most 2 ulp: beyond `TRIG_RANGE` libm's, off by less than 1 ulp; NaN at infinities.
#[inline(always)]
pub fn cos<T: Float>(x: T) -> T {
    if is_beyond_trig(x) {
        x.cos_anywhere()
    } else {
        cos_near(x)
    }
}

/// The sine and the cosine, each with the bits that it has alone.
#[inline(always)]
pub fn sin_cos<T: Float>(x: T) -> (T, T) {
    if is_beyond_trig(x) {
        (x.sin_anywhere(), x.cos_anywhere())
    } else {
        sin_cos_near(x)
    }
}

/// The sine within `TRIG_RANGE`, off by at most 2 ulp; without meaning beyond.
#[inline(always)]
pub fn sin_near<T: Float>(x: T) -> T {
    let (r, quadrant) = x.quadrant();
    in_quadrant(waves(r), quadrant)
}

/// The cosine within `TRIG_RANGE`, off by at most 2 ulp; without meaning beyond.
#[inline(always)]
pub fn cos_near<T: Float>(x: T) -> T {
    let (r, quadrant) = x.quadrant();
    in_quadrant(waves(r), quadrant + T::ONE)
}

/// The bits of [`sin_near`] and [`cos_near`], in little more than the time of one of them.
#[inline(always)]
pub fn sin_cos_near<T: Float>(x: T) -> (T, T) {
    let (r, quadrant) = x.quadrant();
    let waves = waves(r);
    let sine = in_quadrant(waves, quadrant);
    (sine, in_quadrant(waves, quadrant + T::ONE))
}

/// The sine and the cosine of `r` for `|r| <= pi/4`.
#[inline(always)]
fn waves<T: Float>(r: T) -> (T, T) {
    let z = r * r;
    let sine = r + r * (z * polynomial(T::SIN, z));
    let cosine = (T::ONE - T::HALF * z) + z * z * polynomial(T::COS, z);
    // The polynomial loses the sign of zero.
    (sine.with_sign_of(r), cosine)
}

/// `sin(r + k pi/2)`, given the sine and the cosine of `r`, for `quadrant = ROUNDER + k`.
#[inline(always)]
fn in_quadrant<T: Float>((sine, cosine): (T, T), quadrant: T) -> T {
    quadrant.orient(if quadrant.is_odd() { cosine } else { sine })
}

/// The exponential function, off by at most 2 ulp (half the smallest subnormal more where it is subnormal); 0 and
/// infinity where it underflows and overflows.
#[inline(always)]
pub fn exp<T: Float>(x: T) -> T {
    let x = if x < T::EXP_LOW { T::EXP_LOW } else { x };
    let x = if x > T::EXP_HIGH { T::EXP_HIGH } else { x };
    let k = (x * T::LOG2_E + T::ROUNDER) - T::ROUNDER;
    let high = x - k * T::LN2_HIGH;
    let low = k * T::LN2_LOW;
    let r = high - low;
    let value = T::ONE + (high + (r * r * polynomial(T::EXP, r) - low));
    // 2^k itself may lie outside the normal exponents, its halves do not.
    let half = (k * T::HALF + T::ROUNDER) - T::ROUNDER;
    value * half.power_of_two() * (k - half).power_of_two()
}

/// The natural logarithm, off by at most 2 ulp; -infinity at 0, NaN below.
#[inline(always)]
pub fn ln<T: Float>(x: T) -> T {
    let is_subnormal = x < T::MIN_POSITIVE;
    let scaled = if is_subnormal {
        x * T::SUBNORMAL_SCALE
    } else {
        x
    };
    let shift = if is_subnormal {
        T::SUBNORMAL_SHIFT
    } else {
        T::ZERO
    };
    let (k, m) = scaled.split_exponent();
    let value = ln_of_product(k - shift, m);
    let value = if x < T::INFINITY { value } else { x };
    let at_most_zero = if x < T::ZERO { T::NAN } else { -T::INFINITY };
    if x <= T::ZERO { at_most_zero } else { value }
}

/// `ln(2^k m)` for `m` in `[sqrt(1/2), sqrt 2)`.
#[inline(always)]
fn ln_of_product<T: Float>(k: T, m: T) -> T {
    let f = m - T::ONE;
    let s = f / (T::TWO + f);
    let z = s * s;
    let half = T::HALF * f * f;
    let rest = s * (half + z * polynomial(T::LN, z)) + k * T::LN2_LOW;
    k * T::LN2_HIGH - ((half - rest) - f)
}

/// The angle of the point `(x, y)` from the x axis, in (-pi, pi], off by at most 2 ulp; 0 at the origin.
///
/// Zeros have no sign here: on the negative x axis the angle is pi, from either side of it.
#[inline(always)]
pub fn atan2<T: Float>(y: T, x: T) -> T {
    let (v, u) = (y.abs(), x.abs());
    let is_steep = v > u;
    let (n, d) = if is_steep { (u, v) } else { (v, u) };
    let (n, d) = finite_quotient(n, d);
    let angle = atan_of_quotient(n, d);
    // (start, rest) + or - the angle in the first octant.
    let is_left = x < T::ZERO;
    let [axis, rest] = if is_left { T::PI } else { [T::ZERO; 2] };
    let [axis, rest] = if is_steep { T::HALF_PI } else { [axis, rest] };
    let turned = if is_steep != is_left { -angle } else { angle };
    let upper = axis + (rest + turned);
    let angle = if y < T::ZERO { -upper } else { upper };
    let undefined = y + x;
    if is_nan(y) | is_nan(x) {
        undefined
    } else {
        angle
    }
}

/// `(n, d)` with the same quotient for `0 <= n <= d`, such that `n / d` and `n + 2 d` are defined and finite.
#[inline(always)]
fn finite_quotient<T: Float>(n: T, d: T) -> (T, T) {
    let scale = if d > T::LARGE {
        T::HALF * T::HALF
    } else {
        T::ONE
    };
    let (n, d) = (n * scale, d * scale);
    let corner = if n == d { T::ONE } else { T::ZERO };
    let is_infinite = d == T::INFINITY;
    let n = if is_infinite { corner } else { n };
    let d = if is_infinite | (d == T::ZERO) {
        T::ONE
    } else {
        d
    };
    (n, d)
}

/// `atan(n / d)` for `0 <= n <= d`: reduced about 0, 1/2 or 1, with one division.
#[inline(always)]
fn atan_of_quotient<T: Float>(n: T, d: T) -> T {
    // Of the smallest subnormal number 7/16 are rounded to zero, 7/8 are not: 0 is below them.
    let is_low = n + n < T::from_f64(7.0 / 8.0) * d;
    let is_middle = n < T::from_f64(11.0 / 16.0) * d;
    let [start, rest] = if is_middle { T::ATAN_HALF } else { T::ATAN_ONE };
    let [start, rest] = if is_low { [T::ZERO; 2] } else { [start, rest] };
    let (a, b) = if is_middle {
        (n + n - d, d + d + n)
    } else {
        (n - d, d + n)
    };
    let (a, b) = if is_low { (n, d) } else { (a, b) };
    let t = a / b;
    let z = t * t;
    start - ((t * (z * polynomial(T::ATAN, z)) - rest) - t)
}

#[cfg(test)]
mod tests {
    use super::super::samples::Samples;
    use super::*;

    const SEED: u64 = 0xf1e1d;
    const COUNT: usize = 400_000;

    /// How many numbers lie between two `f64` of one sign.
    fn ulps_f64(got: f64, libm: f64) -> f64 {
        if got == libm || got.is_nan() && libm.is_nan() {
            return 0.0;
        }
        assert_eq!(
            got.is_sign_negative(),
            libm.is_sign_negative(),
            "{got:e} for {libm:e}"
        );
        got.to_bits().abs_diff(libm.to_bits()) as f64
    }

    /// Half uniform, half of every magnitude, and sometimes next to a multiple of pi/2.
    fn angle(samples: &mut Samples, range: f64) -> f64 {
        match samples.below(3) {
            0 => samples.uniform(-range, range),
            1 => samples.scaled(-20.0, range.log10()),
            _ => samples.uniform(-range, range).trunc() * std::f64::consts::FRAC_PI_2 % range,
        }
    }

    #[test]
    fn special_values_are_those_of_the_mathematics() {
        let infinity = f64::INFINITY;
        assert_eq!(
            [exp(-infinity), exp(infinity), exp(0.0)],
            [0.0, infinity, 1.0]
        );
        assert_eq!(
            [exp(-746.0), exp(-745.0), exp(710.0)],
            [0.0, 5e-324, infinity]
        );
        assert_eq!([ln(0.0), ln(infinity), ln(1.0)], [-infinity, infinity, 0.0]);
        assert_eq!(
            [ln(-0.0_f32), ln(f32::INFINITY)],
            [f32::NEG_INFINITY, f32::INFINITY]
        );
        assert_eq!(sin(-0.0_f64).to_bits(), (-0.0_f64).to_bits());
        assert_eq!(atan2(0.0, 0.0), 0.0);
        assert_eq!([atan2(0.0, -0.0), atan2(-0.0, -0.0)], [0.0, 0.0]);
        assert_eq!([atan2(0.0, 5e-324), atan2(-0.0, 5e-324)], [0.0, 0.0]);
        assert_eq!(atan2(0.0, f32::from_bits(1)), 0.0);
        let nans = [
            ln(-1.0),
            sin(infinity),
            cos(-infinity),
            sin(f64::NAN),
            exp(f64::NAN),
            ln(f64::NAN),
        ];
        assert!(nans.iter().all(|x| x.is_nan()), "{nans:?}");
        assert!(atan2(f32::NAN, 1.0).is_nan() && atan2(1.0, f32::NAN).is_nan());
    }

    #[test]
    fn angles_are_exact_on_axes_and_at_infinity() {
        use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
        let infinity = f64::INFINITY;
        assert_eq!(
            [atan2(0.0, 2.0), atan2(3.0, 0.0), atan2(-3.0, 0.0)],
            [0.0, FRAC_PI_2, -FRAC_PI_2]
        );
        assert_eq!([atan2(0.0, -1.0), atan2(-0.0, -1.0)], [PI, PI]);
        assert_eq!(
            [atan2(infinity, infinity), atan2(-infinity, -infinity)],
            [FRAC_PI_4, -3.0 * FRAC_PI_4]
        );
        assert_eq!([atan2(1e300, infinity), atan2(1e300, -infinity)], [0.0, PI]);
        assert_eq!(
            [atan2(infinity, 1e300), atan2(f64::MAX, f64::MAX)],
            [FRAC_PI_2, FRAC_PI_4]
        );
    }

    #[test]
    fn floor_agrees_with_the_standard_library_to_the_bit() {
        let mut samples = Samples::new(SEED);
        let special = [
            0.0,
            0.5,
            1.0,
            0.999_999_94,
            1.5,
            8_388_607.5,
            8_388_608.0,
            1e30,
            f32::INFINITY,
            1e-45,
        ];
        let random = (0..COUNT).map(|_| f32::from_bits(samples.bits() as u32));
        for x in special.into_iter().chain(special.map(|x| -x)).chain(random) {
            let same = floor(x).to_bits() == x.floor().to_bits() || x.is_nan() && floor(x).is_nan();
            assert!(same, "{x:e}: {:e}, seed {SEED:#x}", floor(x));
            let y = f64::from(x) * (1.0 + f64::EPSILON);
            assert!(
                floor(y).to_bits() == y.floor().to_bits() || y.is_nan(),
                "{y:e}"
            );
        }
    }

    #[test]
    fn extremes_pass_over_nan_and_take_the_second_of_two_zeros() {
        assert_eq!(
            [
                min(1.0, f64::NAN),
                min(f64::NAN, 1.0),
                max(f64::NAN, 1.0),
                max(1.0, f64::NAN)
            ],
            [1.0; 4]
        );
        assert!(min(f32::NAN, f32::NAN).is_nan());
        assert_eq!(
            [min(1.0, 2.0), max(1.0, 2.0), min(2.0, 1.0), max(2.0, 1.0)],
            [1.0, 2.0, 1.0, 2.0]
        );
        assert!(min(0.0, -0.0_f32).is_sign_negative() && max(0.0, -0.0_f32).is_sign_negative());
        assert!(min(-0.0, 0.0_f32).is_sign_positive() && max(-0.0, 0.0_f32).is_sign_positive());
    }

    /// Where a sine or a cosine is smallest, most of the angle cancels.
    #[test]
    fn waves_beside_every_zero_in_range_are_within_two_ulp() {
        let zeros = (f64::TRIG_RANGE / std::f64::consts::FRAC_PI_2) as u32;
        for k in 1..=zeros {
            let x = f64::from(k) * std::f64::consts::FRAC_PI_2;
            for x in [x.next_down(), x, x.next_up(), -x] {
                let off = ulps_f64(sin(x), libm::sin(x)).max(ulps_f64(cos(x), libm::cos(x)));
                assert!(off <= 2.0, "{off} ulp at {x:e}");
            }
        }
    }

    macro_rules! assert_together {
        ($x:expr) => {
            let x = $x;
            let (sine, cosine) = sin_cos(x);
            let is_same =
                sine.to_bits() == sin(x).to_bits() && cosine.to_bits() == cos(x).to_bits();
            let is_nowhere = !x.is_finite() && sine.is_nan() && cosine.is_nan();
            assert!(is_same || is_nowhere, "{x:e}");
        };
    }

    #[test]
    fn waves_found_together_have_the_bits_of_each_alone() {
        let mut samples = Samples::new(SEED);
        let special = [0.0, -0.0, 1e5, 1e5_f64.next_up(), -3e9, f64::INFINITY];
        let random = (0..COUNT).map(|_| angle(&mut samples, 1e5));
        for x in special.into_iter().chain(random) {
            assert_together!(x);
            assert_together!(x as f32);
        }
    }

    #[test]
    fn sine_and_cosine_stay_within_one() {
        let mut samples = Samples::new(SEED);
        for _ in 0..COUNT {
            let x = angle(&mut samples, 1e5);
            assert!(sin(x).abs() <= 1.0 && cos(x).abs() <= 1.0, "{x:e}");
            let x = x as f32;
            assert!(sin(x).abs() <= 1.0 && cos(x).abs() <= 1.0, "{x:e}");
        }
    }
}
