//! Where in a pixel its samples lie: a function of pixel, sample and seed alone, so that the order of work does not
//! matter.

/// The steps of the R2 sequence: 1/g and 1/g^2 for the plastic number g. Source: Roberts 2018.
const STEP: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];

/// The place of a sample in its pixel, from the middle: each in [-1/2, 1/2). One sample is in the middle; more follow the
/// R2 sequence, shifted by a hash of the pixel.
#[inline(always)]
pub fn place(pixel: [u32; 2], sample: u32, samples: u32, seed: u64) -> [f64; 2] {
    if samples <= 1 {
        return [0.0, 0.0];
    }
    let key = u64::from(pixel[0]) << 32 | u64::from(pixel[1]);
    let first = scrambled(key ^ scrambled(seed));
    let shift = [unit(first), unit(scrambled(first))];
    std::array::from_fn(|axis| (shift[axis] + STEP[axis] * f64::from(sample)).fract() - 0.5)
}

/// A number in [0, 1) from the high bits of a hash.
#[inline(always)]
fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1u64 << 53) as f64
}

/// A hash in which every bit depends on every bit. Source: SplitMix64, Steele, Lea and Flood 2014.
#[inline(always)]
fn scrambled(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_sample_is_in_the_middle() {
        assert_eq!(place([3, 4], 0, 1, 99), [0.0, 0.0]);
    }

    #[test]
    fn samples_stay_in_their_pixel_and_fill_it_evenly() {
        for pixel in [[0, 0], [17, 3], [4000, 3000]] {
            let n = 256;
            let mut cells = [0; 16];
            for k in 0..n {
                let [x, y] = place(pixel, k, n, 7);
                assert!((-0.5..0.5).contains(&x) && (-0.5..0.5).contains(&y));
                cells[((x + 0.5) * 4.0) as usize * 4 + ((y + 0.5) * 4.0) as usize] += 1;
            }
            assert!(
                cells.iter().all(|c| (12..=20).contains(c)),
                "each sixteenth has 16 of 256, give or take 4: {cells:?}"
            );
        }
    }

    #[test]
    fn pixels_and_seeds_differ() {
        let base = place([1, 2], 0, 4, 0);
        assert_ne!(base, place([2, 1], 0, 4, 0));
        assert_ne!(base, place([1, 2], 0, 4, 1));
    }
}
