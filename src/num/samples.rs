//! Random inputs for the tests of this floor: a counter, hashed (splitmix64), so that a seed names a whole sequence.

/// A sequence of random numbers that is fixed by its seed.
pub struct Samples {
    state: u64,
}

impl Samples {
    /// The sequence number `seed`.
    pub fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// 64 random bits. Source: Steele, Lea, Flood 2014, figure 17.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A whole number below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    /// Uniform between `lo` and `hi`.
    pub fn uniform(&mut self, lo: f64, hi: f64) -> f64 {
        let unit = (self.bits() >> 11) as f64 / (1_u64 << 53) as f64;
        lo + (hi - lo) * unit
    }

    /// Either sign, and `10^low` to `10^high` in absolute value, every decade as often.
    pub fn scaled(&mut self, low: f64, high: f64) -> f64 {
        let size = libm::exp10(self.uniform(low, high));
        if self.bits() & 1 == 0 { size } else { -size }
    }
}
