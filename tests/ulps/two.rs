//! The angle of a point.

use super::precision::{Precision, Worst};
use super::samples::{Samples, corners};

fn see<T: Precision>(worst: &mut Worst, y: T, x: T) {
    // The kernel's zeros have no sign, the reference's have.
    let [v, u] = [y.wide() + 0.0, x.wide() + 0.0];
    worst.see(y.atan2(x).ulps(pxfm::f_atan2(v, u)), || {
        format!("({x:e}, {y:e})")
    });
}

/// Points of all pairs of exponents, every `step`-th of either, and of those whose quotient is an ordinary number.
fn check<T: Precision>(step: usize) {
    let mut samples = Samples::new(0xa7a2);
    let mut worst = Worst::NONE;
    for e in (0..T::EXPONENTS).step_by(step) {
        for f in (0..T::EXPONENTS).step_by(step) {
            for _ in 0..4 {
                see::<T>(&mut worst, samples.of_exponent(e), samples.of_exponent(f));
            }
        }
    }
    for _ in 0..300_000 {
        let e = samples.below(T::EXPONENTS);
        let f = (e + samples.below(61))
            .saturating_sub(30)
            .min(T::EXPONENTS - 1);
        see::<T>(&mut worst, samples.of_exponent(e), samples.of_exponent(f));
    }
    let corners = corners::<T>();
    for y in &corners {
        for x in &corners {
            see(&mut worst, *y, *x);
        }
    }
    worst.must_be_within(2.0, &format!("atan2 in {}", T::NAME));
}

#[test]
fn angles_keep_their_bound_for_all_pairs_of_exponents() {
    check::<f32>(1);
    check::<f64>(7);
}

/// The references of functions of two numbers, against those of another library.
#[test]
fn references_of_pairs_are_those_of_libm_within_a_unit() {
    let mut samples = Samples::new(0x11b4);
    let [mut angles, mut powers] = [Worst::NONE, Worst::NONE];
    for _ in 0..300_000 {
        let [y, x] = [(); 2].map(|()| samples.any::<f64>() + 0.0);
        angles.see(libm::atan2(y, x).ulps(pxfm::f_atan2(y, x)), || {
            format!("({x:e}, {y:e})")
        });
        let base = samples.any::<f64>().abs();
        let exponent = samples.uniform(-760.0, 760.0) / pxfm::f_log(base);
        if base.is_finite() && exponent.is_finite() {
            let [got, reference] = [libm::pow, pxfm::f_pow].map(|pow| pow(base, exponent));
            powers.see(got.ulps(reference), || format!("{base:e}^{exponent:e}"));
        }
    }
    angles.must_be_within(1.5, "libm's atan2");
    powers.must_be_within(1.5, "libm's pow");
}
