//! How light weakens over a distance: Beer and Lambert's law, for fog and for absorption.

use crate::scene::Fog;
use glam::DVec3;

/// `exp(-density distance)`, in [0, 1]: 1 for no density even over an infinite distance, 0 over an infinite distance
/// otherwise. Neither may be negative.
pub fn transmittance(density: f64, distance: f64) -> f64 {
    if density == 0.0 || distance == 0.0 {
        return 1.0;
    }
    libm::exp(-(density * distance))
}

/// [`transmittance`] of each channel.
pub fn absorbed(absorb: DVec3, distance: f64) -> DVec3 {
    if absorb == DVec3::ZERO {
        return DVec3::ONE;
    }
    absorb.map(|density| transmittance(density, distance))
}

/// What passes over a segment through fog, and the light that the fog adds to it: `T` and `(1 - T) color`.
pub fn through_fog(fog: &Fog, distance: f64) -> (f64, DVec3) {
    let passed = transmittance(fog.density, distance);
    (passed, fog.color * (1.0 - passed))
}

/// How far one sees through fog: what is further passes less than 2^-12 of its light, half a step of an 8-bit picture in
/// the dark.
pub fn sight(fog: &Fog) -> f64 {
    12.0 * std::f64::consts::LN_2 / fog.density
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clear_air_passes_everything_however_far() {
        for distance in [0.0, 1.0, 1e300, f64::INFINITY] {
            assert_eq!(transmittance(0.0, distance), 1.0);
            assert_eq!(absorbed(DVec3::ZERO, distance), DVec3::ONE);
        }
    }

    #[test]
    fn fog_hides_what_is_infinitely_far() {
        let fog = Fog {
            color: DVec3::new(0.5, 0.6, 0.7),
            density: 1e-3,
        };
        assert_eq!(through_fog(&fog, f64::INFINITY), (0.0, fog.color));
        assert_eq!(transmittance(f64::INFINITY, 0.0), 1.0);
    }

    #[test]
    fn what_is_out_of_sight_passes_nothing_that_is_seen() {
        let fog = Fog {
            color: DVec3::ONE,
            density: 0.07,
        };
        assert!((transmittance(fog.density, sight(&fog)) * 4096.0 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn distances_add_as_factors_multiply() {
        let (a, b) = (transmittance(0.3, 1.25), transmittance(0.3, 4.5));
        assert!((a * b - (-0.3f64 * 5.75).exp()).abs() < 1e-15);
    }

    #[test]
    fn channels_weaken_apart() {
        let passed = absorbed(DVec3::new(0.0, 1.0, 2.0), 0.5);
        let law = DVec3::new(1.0, (-0.5f64).exp(), (-1.0f64).exp());
        assert!(passed.abs_diff_eq(law, 1e-15));
    }
}
