//! Arguments: strata over all that a floating point number can be.

use super::precision::Precision;

/// A sequence of random numbers that is fixed by its seed.
pub struct Samples(u64);

impl Samples {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 64 random bits (splitmix64). Source: Steele, Lea, Flood 2014, figure 17.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, n: u64) -> u64 {
        self.bits() % n
    }

    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A fraction: all zeros, all ones, a single bit at either end, or random.
    fn fraction(&mut self, bits: u32) -> u64 {
        let all = (1 << bits) - 1;
        match self.below(16) {
            0 => 0,
            1 => all,
            2 => 1,
            3 => all - 1,
            4 => 1 << (bits - 1),
            _ => self.bits() & all,
        }
    }

    /// A number of either sign with the biased exponent `exponent`: 0 for zero and subnormal numbers, the last one for
    /// infinity and NaN.
    pub fn of_exponent<T: Precision>(&mut self, exponent: u64) -> T {
        let fraction = self.fraction(T::FRACTION_BITS);
        let sign = self.bits() & 1;
        let exponent_bits = T::EXPONENTS.trailing_zeros();
        T::from_pattern((((sign << exponent_bits) | exponent) << T::FRACTION_BITS) | fraction)
    }

    /// Any number there is, every exponent as often.
    pub fn any<T: Precision>(&mut self) -> T {
        let exponent = self.below(T::EXPONENTS);
        self.of_exponent(exponent)
    }
}

/// Numbers at which something changes, of both signs.
pub fn corners<T: Precision>() -> Vec<T> {
    let halves = (1..40).map(|n| f64::from(n) * std::f64::consts::FRAC_PI_4);
    let ends = [
        0.0,
        1.0,
        1e5,
        104.0,
        103.97,
        105.0,
        87.34,
        88.72,
        88.73,
        89.0,
        708.39,
        709.78,
        709.79,
        710.0,
        744.44,
        745.13,
        745.14,
        746.0,
        f64::NAN,
    ];
    let mut all: Vec<T> = halves.chain(ends).map(T::nearest).collect();
    all.extend(
        [0, 1, T::EXPONENTS - 2, T::EXPONENTS - 1].map(|e| T::from_pattern(e << T::FRACTION_BITS)),
    );
    let beside: Vec<T> = all
        .iter()
        .flat_map(|x| [x.pattern().wrapping_sub(1), x.pattern() + 1].map(T::from_pattern))
        .collect();
    all.extend(beside);
    let negative: Vec<T> = all.iter().map(|x| -*x).collect();
    all.extend(negative);
    all
}
