//! Functions of one number.

use super::precision::{Precision, Worst};
use super::samples::{Samples, corners};
use fieldstone::num::Number;
use rayon::prelude::*;

/// A function over a width, its reference, and its bound in units of the last place.
struct Function<T> {
    name: &'static str,
    value: fn(T) -> T,
    reference: fn(f64) -> f64,
    bound: f64,
}

impl<T: Precision> Function<T> {
    fn all() -> [Self; 8] {
        let of = |name, value, reference, bound| Self {
            name,
            value,
            reference,
            bound,
        };
        [
            of("sin", T::sin, pxfm::f_sin, 2.0),
            of("cos", T::cos, pxfm::f_cos, 2.0),
            of("exp", T::exp, pxfm::f_exp, 2.0),
            of("ln", T::ln, pxfm::f_log, 2.0),
            of("sqrt", T::sqrt, f64::sqrt, 0.5),
            of("tan", T::tan, pxfm::f_tan, 5.0),
            of("asin", T::asin, pxfm::f_asin, 5.0),
            of("acos", T::acos, pxfm::f_acos, 5.0),
        ]
    }

    fn see(&self, worst: &mut Worst, x: T) {
        worst.see((self.value)(x).ulps((self.reference)(x.wide())), || {
            format!("{x:e}")
        });
    }

    fn check(&self, worst: &Worst) {
        worst.must_be_within(self.bound, &format!("{} in {}", self.name, T::NAME));
    }
}

/// Every so many-th `f32` is looked at: a prime, so that the low bits take all values.
const STRIDE: usize = 2039;

/// 2.1 million numbers that are spread evenly over all bit patterns, both signs, subnormals, infinity and NaN.
#[test]
fn single_precision_keeps_its_bounds_over_the_whole_range() {
    for function in Function::<f32>::all() {
        let mut worst = Worst::NONE;
        for bits in (0..=u32::MAX).step_by(STRIDE) {
            function.see(&mut worst, f32::from_bits(bits));
        }
        for x in corners() {
            function.see(&mut worst, x);
        }
        function.check(&worst);
    }
}

/// The numbers of the table in `num/kernels.rs` come from here.
#[test]
#[ignore = "all 2^32 numbers: half an hour of one processor; cargo test --release --test ulps -- --ignored --nocapture every_single"]
fn every_single_precision_number_keeps_the_bounds() {
    for function in Function::<f32>::all() {
        let worst = (0..=u16::MAX).into_par_iter().map(|high| {
            let mut worst = Worst::NONE;
            for low in 0..=u16::MAX {
                function.see(
                    &mut worst,
                    f32::from_bits(u32::from(high) << 16 | u32::from(low)),
                );
            }
            worst
        });
        function.check(&worst.reduce(|| Worst::NONE, Worst::or));
    }
}

/// Numbers of every exponent, and more of those where a function has its curves: beside multiples of pi/2, beside 1, and up
/// to the reach of the exponential.
fn doubles() -> impl Iterator<Item = f64> {
    let mut samples = Samples::new(0xd0b1e);
    let mut every = Samples::new(0xe8e);
    let strata = (0..f64::EXPONENTS).flat_map(move |e| [(); 64].map(|()| every.of_exponent(e)));
    let curves = (0..120_000).map(move |n| match n % 6 {
        0 => samples.uniform(-4.0, 4.0),
        1 => samples.uniform(-750.0, 750.0),
        2 => samples.uniform(-1.1e5, 1.1e5),
        3 => {
            let near = samples.uniform(-7e4, 7e4).trunc() * std::f64::consts::FRAC_PI_2;
            near + samples.uniform(-1e-9, 1e-9)
        }
        4 => samples.uniform(-7e4, 7e4).trunc() * std::f64::consts::FRAC_PI_2,
        _ => (1.0 - libm::exp10(samples.uniform(-16.0, 0.0))).copysign(samples.uniform(-1.0, 1.0)),
    });
    corners().into_iter().chain(strata).chain(curves)
}

#[test]
fn double_precision_keeps_its_bounds_over_the_whole_range() {
    for function in Function::<f64>::all() {
        let mut worst = Worst::NONE;
        for x in doubles() {
            function.see(&mut worst, x);
        }
        function.check(&worst);
    }
}

/// Two libraries, written apart.
#[test]
fn references_are_those_of_libm_within_a_unit() {
    type Pair = (&'static str, fn(f64) -> f64, fn(f64) -> f64);
    let pairs: [Pair; 7] = [
        ("sin", pxfm::f_sin, libm::sin),
        ("cos", pxfm::f_cos, libm::cos),
        ("exp", pxfm::f_exp, libm::exp),
        ("ln", pxfm::f_log, libm::log),
        ("tan", pxfm::f_tan, libm::tan),
        ("asin", pxfm::f_asin, libm::asin),
        ("acos", pxfm::f_acos, libm::acos),
    ];
    for (name, reference, libm) in pairs {
        let mut worst = Worst::NONE;
        for x in doubles() {
            worst.see(libm(x).ulps(reference(x)), || format!("{x:e}"));
        }
        worst.must_be_within(1.5, &format!("libm's {name}"));
    }
}

/// As far as the kernels reach, both sides of 1e5, and to the largest number.
#[test]
fn far_angles_have_the_waves_of_libm() {
    let mut samples = Samples::new(0xfa4);
    let beyond = (0..200_000).map(|_| {
        let exponent = 1023 + 16 + samples.below(1024 - 16);
        samples.of_exponent::<f64>(exponent)
    });
    for x in beyond.chain([1e5_f64.next_up(), -1e5_f64.next_up(), f64::MAX]) {
        if x.abs() > 1e5 {
            let waves = [Number::sin(x), Number::cos(x)].map(f64::to_bits);
            assert_eq!(
                waves,
                [libm::sin(x), libm::cos(x)].map(f64::to_bits),
                "{x:e}"
            );
        }
        let x = x as f32;
        if x.abs() > 1e5 && x.is_finite() {
            let waves = [Number::sin(x), Number::cos(x)].map(f32::to_bits);
            assert_eq!(
                waves,
                [libm::sinf(x), libm::cosf(x)].map(f32::to_bits),
                "{x:e}"
            );
        }
    }
}
