//! Powers with exponents that are no whole numbers.

use super::precision::{Precision, Worst};
use super::samples::{Samples, corners};

/// The documented bound at `x^e`.
fn bound(x: f64, e: f64) -> f64 {
    2.0 + 3.0 * (e * pxfm::f_log(x)).abs()
}

/// The error as a share of its bound.
fn share<T: Precision>(x: T, e: T) -> f64 {
    let ulps = x.pow(e).ulps(pxfm::f_pow(x.wide(), e.wide()));
    if ulps == 0.0 {
        0.0
    } else {
        ulps / bound(x.wide(), e.wide())
    }
}

/// Bases of every exponent, raised to what takes them to results of every size: from below the smallest number to beyond
/// the largest.
fn check<T: Precision>(reach: f64) {
    let mut samples = Samples::new(0xb0e4);
    let mut worst = Worst::NONE;
    let mut see = |x: T, e: T| worst.see(share(x, e), || format!("{x:e}^{e:e}"));
    for exponent in 0..T::EXPONENTS - 1 {
        for n in 0..400_000 / T::EXPONENTS {
            let x = samples.of_exponent::<T>(exponent).abs();
            let log = pxfm::f_log(x.wide());
            let wanted = match n % 4 {
                0 => libm::exp2(samples.uniform(-60.0, 0.0)).copysign(samples.uniform(-1.0, 1.0)),
                _ => samples.uniform(-reach, reach),
            };
            let e = T::nearest(wanted / log);
            if log.is_finite() && e.wide().is_finite() {
                see(x, e);
            }
        }
    }
    for _ in 0..100_000 {
        let x = T::nearest(1.0 + libm::exp2(samples.uniform(-f64::from(T::FRACTION_BITS), -1.0)));
        let e = T::nearest(samples.uniform(-reach, reach) / pxfm::f_log(x.wide()));
        see(x, e);
        see(T::splat(1.0) / x, e);
        let (x, e) = (samples.any::<T>().abs(), samples.any::<T>());
        if x.wide().is_finite() && e.wide().is_finite() {
            see(x, e);
        }
    }
    worst.must_be_within(1.0, &format!("pow in {}, as a share of its bound", T::NAME));
}

#[test]
fn powers_keep_their_bound_over_the_whole_range() {
    check::<f32>(110.0);
    check::<f64>(760.0);
}

/// The one difference from C's `pow` at positive bases: 1 to an infinite power has no value.
#[test]
fn powers_of_corners_are_those_of_the_limits() {
    fn check<T: Precision>() {
        let corners = corners::<T>();
        for x in corners.iter().filter(|x| x.wide() >= 0.0) {
            for e in &corners {
                let (x, e) = (*x, *e);
                let got = x.pow(e);
                if x.wide() == 1.0 && !e.wide().is_finite() {
                    assert!(got.wide().is_nan(), "1^{e:e} = {got:e}");
                } else if !(x.wide() > 0.0 && x.wide().is_finite() && e.wide().is_finite()) {
                    // Even zeros of negative sign count as positive.
                    let reference = pxfm::f_pow(x.wide().abs(), e.wide());
                    let is_same = got.ulps(reference) == 0.0;
                    assert!(is_same, "{x:e}^{e:e} = {got:e}, not {reference:e}");
                }
            }
        }
        for e in &corners {
            let got = T::splat(-1.0).pow(*e);
            let is_right = if e.wide() == 0.0 {
                got.wide() == 1.0
            } else {
                got.wide().is_nan()
            };
            assert!(is_right, "(-1)^{e:e} = {got:e}");
        }
    }
    check::<f32>();
    check::<f64>();
}
