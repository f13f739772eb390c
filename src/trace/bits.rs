//! Sets of lanes as bits.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

/// How many lanes are told at once.
pub(super) const LANES: usize = 8;

/// The power of two of each lane.
const POWERS: [f64; LANES] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0];

/// Added to a small whole number, it leaves that in the lowest bits.
const SHIFTED: f64 = (1u64 << 52) as f64;

/// A bit for each lane for which `holds`, from the lowest on. Within a task. The bits are added as numbers, half by half: sums
/// of integers are put in another order by the compiler, in which most of it is done lane by lane.
#[inline(always)]
pub(super) fn bits(holds: impl Fn(usize) -> bool) -> u32 {
    let mut powers = [0.0; LANES];
    for lane in 0..LANES {
        powers[lane] = if holds(lane) { POWERS[lane] } else { 0.0 };
    }
    let (mut four, mut two) = ([0.0; LANES / 2], [0.0; LANES / 4]);
    for lane in 0..LANES / 2 {
        four[lane] = powers[lane] + powers[lane + LANES / 2];
    }
    for lane in 0..LANES / 4 {
        two[lane] = four[lane] + four[lane + LANES / 4];
    }
    (two[0] + two[1] + SHIFTED).to_bits() as u32
}

/// The numbers of the bits that are set, in order.
#[inline(always)]
pub(super) fn ones(bits: u32) -> impl Iterator<Item = usize> {
    let mut left = bits;
    std::iter::from_fn(move || {
        let first = (left != 0).then(|| left.trailing_zeros() as usize);
        left &= left.wrapping_sub(1);
        first
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_those_of_the_lanes_that_hold() {
        for set in 0..256u32 {
            let found = bits(|lane| set >> lane & 1 == 1);
            let lanes: Vec<usize> = ones(found).collect();
            let meant: Vec<usize> = (0..LANES).filter(|lane| set >> lane & 1 == 1).collect();
            assert_eq!((found, lanes), (set, meant));
        }
    }
}
