//! The mirrored direction.

use crate::trace::vector::{select, unit_or};
use glam::DVec3;

/// `R = I - 2 N (I.N)` for unit vectors, with `normal` against `incident`; never below the surface, whatever the
/// normal: what rounding puts there is laid into it.
#[inline(always)]
pub fn reflected(incident: DVec3, normal: DVec3) -> DVec3 {
    let mirrored = incident - normal * (2.0 * incident.dot(normal));
    let above = mirrored.dot(normal);
    let level = unit_or(mirrored - normal * above, normal);
    select(above >= 0.0, mirrored, level)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angle_out_is_angle_in() {
        for degrees in [0.0f64, 30.0, 60.0, 89.9] {
            let a = degrees.to_radians();
            let r = reflected(DVec3::new(a.sin(), -a.cos(), 0.0), DVec3::Y);
            assert!(r.abs_diff_eq(DVec3::new(a.sin(), a.cos(), 0.0), 1e-15));
        }
    }

    #[test]
    fn a_ray_from_below_stays_above() {
        let r = reflected(DVec3::new(0.8, 0.6, 0.0), DVec3::Y);
        assert!(r.abs_diff_eq(DVec3::X, 1e-15));
    }
}
