//! The transfer function of sRGB. Source: IEC 61966-2-1:1999.

use std::sync::LazyLock;

/// Linear light in [0, 1] from an encoded value in [0, 1].
pub fn decode(encoded: f64) -> f64 {
    if encoded <= 0.04045 {
        encoded / 12.92
    } else {
        libm::pow((encoded + 0.055) / 1.055, 2.4)
    }
}

/// The linear light at which the rounded code changes from k to k + 1.
///
/// A search among these is the definition, rounding included, without a power for each channel of each pixel.
static STEPS: LazyLock<[f64; 255]> =
    LazyLock::new(|| std::array::from_fn(|k| decode((k as f64 + 0.5) / 255.0)));

/// How finely linear light is divided for [`FIRST`]: no more than one step lies in a part.
const PARTS: usize = 4096;

/// The code at which each part of [0, 1] begins.
static FIRST: LazyLock<[u8; PARTS]> = LazyLock::new(|| {
    std::array::from_fn(|part| {
        let start = part as f64 / PARTS as f64;
        STEPS.partition_point(|step| *step <= start) as u8
    })
});

/// The 8-bit code of `linear` light, clamped to [0, 1] and rounded; 0 for NaN.
pub fn encode(linear: f64) -> u8 {
    Codes::new().of(linear)
}

/// The codes of light, for many numbers.
#[derive(Clone, Copy, Debug)]
pub struct Codes {
    steps: &'static [f64; 255],
    first: &'static [u8; PARTS],
}

impl Codes {
    /// All of them.
    pub fn new() -> Self {
        Self {
            steps: &STEPS,
            first: &FIRST,
        }
    }

    /// As [`encode`].
    #[inline]
    pub fn of(&self, linear: f64) -> u8 {
        // What is not a number, or negative, is in the first part.
        let part = (linear * PARTS as f64) as usize;
        let mut code = usize::from(self.first[part.min(PARTS - 1)]);
        while code < self.steps.len() && self.steps[code] <= linear {
            code += 1;
        }
        code as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The definition.
    fn code(linear: f64) -> f64 {
        let x = linear.clamp(0.0, 1.0);
        let encoded = if x <= 0.003_130_8 {
            12.92 * x
        } else {
            1.055 * x.powf(1.0 / 2.4) - 0.055
        };
        255.0 * encoded
    }

    #[test]
    fn published_values() {
        assert_eq!(encode(0.0), 0);
        assert_eq!(encode(1.0), 255);
        // 0.5 gives 187.516, the boundary of the linear piece 10.31, grey of 18 % 117.6.
        assert_eq!(encode(0.5), 188);
        assert_eq!(encode(0.003_130_8), 10);
        assert_eq!(encode(0.18), 118);
        assert_eq!(encode(0.214_041_140_482_326), 128);
    }

    #[test]
    fn every_code_is_the_rounded_definition() {
        for i in 0..=1_000_000 {
            let linear = f64::from(i) / 1e6;
            let exact = code(linear);
            // The two pieces of the standard meet only to 3e-8, so a value that close to a half may go either way.
            let is_tie = (exact.fract() - 0.5).abs() < 1e-4;
            assert!(
                is_tie || f64::from(encode(linear)) == exact.round(),
                "{linear}"
            );
        }
    }

    #[test]
    fn codes_change_at_the_steps_and_nowhere_else() {
        for (k, step) in STEPS.iter().enumerate() {
            assert_eq!(usize::from(encode(*step)), k + 1);
            assert_eq!(usize::from(encode(step.next_down())), k);
        }
    }

    #[test]
    fn every_code_survives_decoding() {
        for k in 0..=255u8 {
            assert_eq!(encode(decode(f64::from(k) / 255.0)), k);
        }
    }

    #[test]
    fn what_is_out_of_range_is_clamped() {
        assert_eq!(encode(-1.0), 0);
        assert_eq!(encode(7.0), 255);
        assert_eq!(encode(f64::INFINITY), 255);
        assert_eq!(encode(f64::NEG_INFINITY), 0);
        assert_eq!(encode(f64::NAN), 0);
    }
}
