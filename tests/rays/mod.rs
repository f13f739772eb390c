//! Rays for tests.

use fieldstone::trace::{Footprint, Ray};
use glam::DVec3;

/// Numbers in [0, 1) from a counter. Source: the finalizer of MurmurHash3.
pub fn random(i: u64) -> f64 {
    let mut z = i
        .wrapping_add(0x9e37_79b9_7f4a_7c15)
        .wrapping_mul(0xff51_afd7_ed55_8ccd);
    z = (z ^ (z >> 33)).wrapping_mul(0xc4ce_b9fe_1a85_ec53);
    ((z ^ (z >> 33)) >> 11) as f64 / (1u64 << 53) as f64
}

/// A ray of a camera with about a thousand pixels.
pub fn ray(origin: [f64; 3], direction: [f64; 3]) -> Ray {
    Ray {
        origin: DVec3::from_array(origin),
        direction: DVec3::from_array(direction).normalize(),
        t_max: f64::INFINITY,
        footprint: Footprint {
            at_origin: 0.0,
            spread: 1e-3,
        },
    }
}

/// Rays from a sphere of radius 3 towards points of a box of half-width 0.7.
pub fn aimed(n: u64, seed: u64) -> Vec<Ray> {
    (0..n)
        .map(|i| {
            let x = |k: u64| 2.0 * random(seed + i * 8 + k) - 1.0;
            let eye = DVec3::new(x(0), x(1), x(2)).normalize_or(DVec3::X) * 3.0;
            let target = DVec3::new(x(3), x(4), x(5)) * 0.7;
            ray(eye.to_array(), (target - eye).to_array())
        })
        .collect()
}
