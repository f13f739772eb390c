//! The two widths, and errors in units of the last place.

use fieldstone::num::Number;
use std::fmt::LowerExp;

/// A floating point number with its bits.
pub trait Precision: Number + LowerExp {
    const NAME: &'static str;
    const FRACTION_BITS: u32;
    /// How many exponents there are, with those of subnormal numbers and of infinity.
    const EXPONENTS: u64;

    fn from_pattern(bits: u64) -> Self;
    fn pattern(self) -> u64;
    fn nearest(x: f64) -> Self;
    fn wide(self) -> f64;

    /// How far `self` is from the exact value that rounds to `reference` in `f64`, in units of the last place: at least
    /// so much, and infinite where one of the two is NaN. Zeros have no sign, and infinity is next after the largest
    /// number.
    fn ulps(self, reference: f64) -> f64;
}

impl Precision for f64 {
    const NAME: &'static str = "f64";
    const FRACTION_BITS: u32 = 52;
    const EXPONENTS: u64 = 1 << 11;

    fn from_pattern(bits: u64) -> Self {
        Self::from_bits(bits)
    }
    fn pattern(self) -> u64 {
        self.to_bits()
    }
    fn nearest(x: f64) -> Self {
        x
    }
    fn wide(self) -> f64 {
        self
    }

    /// The numbers from here to the reference, which is itself off by up to half of one.
    fn ulps(self, reference: f64) -> f64 {
        if self.is_nan() || reference.is_nan() {
            return if self.is_nan() && reference.is_nan() {
                0.0
            } else {
                f64::INFINITY
            };
        }
        match place(self).abs_diff(place(reference)) {
            0 => 0.0,
            steps => steps as f64 + 0.5,
        }
    }
}

/// The place of a number among all, 0 for both zeros.
fn place(x: f64) -> i64 {
    let size = x.abs().to_bits() as i64;
    if x.is_sign_negative() { -size } else { size }
}

impl Precision for f32 {
    const NAME: &'static str = "f32";
    const FRACTION_BITS: u32 = 23;
    const EXPONENTS: u64 = 1 << 8;

    fn from_pattern(bits: u64) -> Self {
        Self::from_bits(bits as u32)
    }
    fn pattern(self) -> u64 {
        self.to_bits().into()
    }
    fn nearest(x: f64) -> Self {
        x as f32
    }
    fn wide(self) -> f64 {
        self.into()
    }

    fn ulps(self, reference: f64) -> f64 {
        let nearest = reference as f32;
        let is_same = self.is_nan() && reference.is_nan();
        if is_same || self.is_infinite() && self == nearest {
            return 0.0;
        }
        if self.is_nan() || !reference.is_finite() {
            return f64::INFINITY;
        }
        let got = if self.is_infinite() {
            libm::ldexp(1.0, 128).copysign(self.into())
        } else {
            self.into()
        };
        (got - reference).abs() / unit(reference)
    }
}

/// The distance of `f32` numbers of the size of `x`.
fn unit(x: f64) -> f64 {
    let exponent = (x.abs().to_bits() >> 52) as i32 - 1023;
    libm::ldexp(1.0, exponent.clamp(-126, 127) - 23)
}

/// The largest error seen, and where.
#[derive(Clone, Debug)]
pub struct Worst {
    pub ulps: f64,
    pub at: String,
}

impl Worst {
    pub const NONE: Self = Self {
        ulps: 0.0,
        at: String::new(),
    };

    /// Takes note of an error, whose place is written down only if it is the largest.
    pub fn see(&mut self, ulps: f64, at: impl FnOnce() -> String) {
        if ulps > self.ulps || ulps.is_nan() {
            *self = Self { ulps, at: at() };
        }
    }

    /// The larger of two.
    pub fn or(self, other: Self) -> Self {
        if other.ulps > self.ulps { other } else { self }
    }

    /// Prints the error and fails where it is above `bound`.
    pub fn must_be_within(&self, bound: f64, name: &str) {
        println!("{name}: off by {:.4} at {}", self.ulps, self.at);
        assert!(
            self.ulps <= bound,
            "{name}: off by {} at {}, not {bound}",
            self.ulps,
            self.at
        );
    }
}

#[test]
fn errors_are_counted_in_units_of_the_last_place() {
    let next = 1.0_f32.next_up();
    assert_eq!(
        [next.ulps(1.0), 1.0_f32.ulps(next.into()), 1.0_f32.ulps(1.0)],
        [1.0, 1.0, 0.0]
    );
    assert_eq!(1.0_f32.ulps(1.0 + 2f64.powi(-24)), 0.5);
    assert_eq!(
        [f32::from_bits(3).ulps(0.0), 0.0_f32.ulps(-1e-300)].map(f64::round),
        [3.0, 0.0]
    );
    assert_eq!(
        [
            f32::INFINITY.ulps(1e39),
            f32::INFINITY.ulps(f32::MAX.into())
        ],
        [0.0, 1.0]
    );
    assert!(f32::MAX.ulps(1e39) > 1e7 && f32::MAX.ulps(f64::INFINITY) == f64::INFINITY);
    assert_eq!(
        [f32::NAN.ulps(1.0), 1.0_f32.ulps(f64::NAN)],
        [f64::INFINITY; 2]
    );
    assert_eq!([f32::NAN.ulps(f64::NAN), f64::NAN.ulps(f64::NAN)], [0.0; 2]);
    assert_eq!(
        [
            1.0.ulps(1.0_f64.next_up()),
            (-0.0).ulps(5e-324),
            (-0.0).ulps(0.0)
        ],
        [1.5, 1.5, 0.0]
    );
    assert_eq!(
        [f64::MAX.ulps(f64::INFINITY), 1.0.ulps(f64::NAN)],
        [1.5, f64::INFINITY]
    );
}
