//! The highlights of Phong and Blinn, side by side.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use crate::num::{F64x32, Lanes, Number};

/// How many highlights are found at once.
pub const GROUP: usize = F64x32::WIDTH;

/// A number for each of them.
pub type Group = [f64; GROUP];

/// The numbers of columns from number `first` on. Groups begin at multiples of their length, and columns go on to the next.
///
/// # Panics
/// If they have less.
#[inline(always)]
pub fn groups<const N: usize>(columns: [&[f64]; N], first: usize) -> [&Group; N] {
    let mut groups = [&[0.0; GROUP]; N];
    for (group, column) in groups.iter_mut().zip(columns) {
        let rest = column[first..].first_chunk();
        *group = rest.expect("columns go on to the end of a group");
    }
    groups
}

/// Highlights below `exp` of this are 0: 2^-53, what rounding would take from a full one anyway.
const FAINTEST_LOG: f64 = -36.7;

/// Highlights, in [0, 1], for the cosines of Phong and of Blinn, the exponents (not negative) and the shares of Blinn's; the
/// rest is Phong's. To be called with the instructions of lanes.
#[inline(always)]
pub fn highlights([phong, blinn]: [&Group; 2], exponent: &Group, share: &Group) -> Group {
    let (mut mirror, mut halfway) = ([0.0; GROUP], [0.0; GROUP]);
    for i in 0..GROUP {
        mirror[i] = if share[i] != 1.0 { phong[i] } else { 0.0 };
        halfway[i] = if share[i] != 0.0 { blinn[i] } else { 0.0 };
    }
    let (phong, blinn) = (lobes(&mirror, exponent), lobes(&halfway, exponent));
    let mut both = [0.0; GROUP];
    for i in 0..GROUP {
        let mix = phong[i] * (1.0 - share[i]) + blinn[i] * share[i];
        let one = if share[i] == 0.0 { phong[i] } else { blinn[i] };
        let is_one = (share[i] == 0.0) | (share[i] == 1.0);
        both[i] = if is_one { one } else { mix };
    }
    both
}

/// `cosine^exponent` in front, 0 behind; also where the exponent is 0, for which a plain power would give 0^0 = 1.
#[inline(always)]
fn lobes(cosine: &Group, exponent: &Group) -> Group {
    let mut is_near = [0u64; GROUP];
    let mut near = 0;
    for i in 0..GROUP {
        // ln c <= c - 1 bounds the power from above: most points need none, a tenth of the time of three spheres.
        let is_more = exponent[i] * (cosine[i] - 1.0) > FAINTEST_LOG;
        is_near[i] = u64::from((cosine[i] > 0.0) & is_more);
        near += is_near[i];
    }
    if near == 0 {
        return [0.0; GROUP];
    }
    let first = is_near.iter().position(|is| *is != 0);
    let common = exponent[first.unwrap_or(0)];
    let mut others = 0;
    let mut base = [0.0; GROUP];
    for i in 0..GROUP {
        others += is_near[i] & u64::from(exponent[i] != common);
        base[i] = if cosine[i] < 1.0 { cosine[i] } else { 1.0 };
    }
    let powers = if others == 0 && is_short(common) {
        Lanes(base).powi(common as i32).0
    } else {
        one_by_one(&base, exponent, &is_near)
    };
    let mut lobes = [0.0; GROUP];
    for i in 0..GROUP {
        lobes[i] = if is_near[i] != 0 { powers[i] } else { 0.0 };
    }
    lobes
}

/// The powers where they count. Rare: where surfaces with different highlights lie side by side.
#[cold]
#[inline(never)]
fn one_by_one(base: &Group, exponent: &Group, counts: &[u64; GROUP]) -> Group {
    let mut powers = [0.0; GROUP];
    for i in (0..GROUP).filter(|i| counts[*i] != 0) {
        powers[i] = power(base[i], exponent[i]);
    }
    powers
}

/// Whether powers with this exponent take a few multiplications.
#[inline(always)]
fn is_short(exponent: f64) -> bool {
    exponent <= 1024.0 && exponent.fract() == 0.0
}

/// `x^exponent`; for whole exponents, as most are, by a few multiplications.
fn power(x: f64, exponent: f64) -> f64 {
    if is_short(exponent) {
        Number::powi(x, exponent as i32)
    } else {
        libm::pow(x, exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::samples::random;
    use std::array;

    #[test]
    fn highlights_are_powers_whatever_lies_beside_them() {
        let mixes: [&[f64]; 5] = [&[50.0], &[3.0, 700.0], &[0.0, 2.5], &[1500.0], &[1.0, 33.0]];
        for (k, exponents) in mixes.into_iter().enumerate() {
            for round in 0..50 {
                let at = |column: usize, i: usize| {
                    random((((k * 50 + round) * 3 + column) * GROUP + i) as u64)
                };
                let cosine = |column| array::from_fn(|i| 1.3 * at(column, i) - 0.3);
                let [phong, blinn]: [Group; 2] = [cosine(0), cosine(1)];
                let exponent = array::from_fn(|i| exponents[i % exponents.len()]);
                let share = array::from_fn(|i| [0.0, 1.0, at(2, i)][i % 3]);
                let found = highlights([&phong, &blinn], &exponent, &share);
                for i in 0..GROUP {
                    let law = |c: f64| {
                        if c > 0.0 {
                            libm::pow(c.min(1.0), exponent[i])
                        } else {
                            0.0
                        }
                    };
                    let law = law(phong[i]) * (1.0 - share[i]) + law(blinn[i]) * share[i];
                    assert!((found[i] - law).abs() <= 1e-15 * (1.0 + exponent[i]) * law + 2e-16);
                }
            }
        }
    }
}
