//! The mirrored direction.

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

/// The direction of `v`, or `other` where it has none. Without branches, to serve in lanes.
#[inline(always)]
pub(super) fn unit_or(v: DVec3, other: DVec3) -> DVec3 {
    let scale = 1.0 / v.length();
    let is_scale = (scale > 0.0) & (scale <= f64::MAX);
    select(is_scale, v * scale, other)
}

/// `a` where that holds, else `b`. Without branches, to serve in lanes.
#[inline(always)]
pub(super) fn select(holds: bool, a: DVec3, b: DVec3) -> DVec3 {
    DVec3::new(
        if holds { a.x } else { b.x },
        if holds { a.y } else { b.y },
        if holds { a.z } else { b.z },
    )
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
