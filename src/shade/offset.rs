//! Where secondary rays start: the one place where a ray is moved off the surface that it leaves.
//!
//! There is no absolute epsilon. Let `p` be the point that the tracer reports and `q` the surface point on the same ray.
//! Their distance is at most `error`, the tracer's own bound on `t`, so the distance from `p` to the surface is at most
//! `error` too, whatever the angle and the curvature. Writing `p = o + t d` in f64 rounds each coordinate by at most
//! `u (t + |p|)` for the two operations and `2u t` for the length of `d`, with `u = 2^-53`; `4u (t + |p|)`, with the
//! largest coordinate of `p`, bounds their sum. A start at `p + 2 (error + 4u (t + |p|)) n` lies on the side of `n`, by at least as much as
//! `p` may lie beyond it. Lengths scale with the scene, so scaling it by a power of two keeps the bits.

use crate::trace::vector::select;
use glam::DVec3;

/// Half the distance between 1 and the next number: the largest relative error of rounding.
const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// Where a ray starts that leaves a hit at `point`, at distance `t` with this `error`, towards the side of the unit normal
/// `side`.
#[inline(always)]
pub fn start(point: DVec3, t: f64, error: f64, side: DVec3) -> DVec3 {
    let size = point.abs();
    let larger = if size.x > size.y { size.x } else { size.y };
    let largest = if larger > size.z { larger } else { size.z };
    let rounding = 4.0 * UNIT_ROUNDOFF * (t + largest);
    point + side * (2.0 * (error + rounding))
}

/// Whether a ray comes from the outside of the surface that it meets, along the surface included.
#[inline(always)]
pub fn is_outside(outward: DVec3, incident: DVec3) -> bool {
    outward.dot(incident) <= 0.0
}

/// The unit normal on the side from which a ray comes.
#[inline(always)]
pub fn facing(outward: DVec3, incident: DVec3) -> DVec3 {
    select(is_outside(outward, incident), outward, -outward)
}

/// How far a shadow ray to a light at `distance` is followed: what stands at the light or behind it casts no shadow.
#[inline(always)]
pub fn before(distance: f64) -> f64 {
    distance * (1.0 - 4.0 * UNIT_ROUNDOFF)
}

#[cfg(test)]
mod tests {
    use super::*;
    #[test]
    fn start_is_on_its_side_for_every_point_within_the_error() {
        let n = DVec3::new(1.0, 2.0, -2.0) / 3.0;
        for scale in [1e-12, 1.0, 1e12] {
            for wrong in [-1.0, -0.5, 0.0, 0.5, 1.0] {
                let error = 1e-6 * scale;
                let p = DVec3::new(3.0, -5.0, 7.0) * scale;
                let reported = p + n * (wrong * error);
                let q = start(reported, 9.0 * scale, error, n);
                let above = (q - p).dot(n);
                assert!(above > 0.0 && above < 4.0 * error);
            }
        }
    }

    #[test]
    fn exact_hits_are_displaced_by_rounding_alone() {
        let p = DVec3::new(0.0, 0.0, 0.0);
        let q = start(p, 2.0, 0.0, DVec3::Y);
        assert!(q.y > 0.0 && q.y <= 8.0 * f64::EPSILON);
    }

    #[test]
    fn scaling_by_a_power_of_two_keeps_the_bits() {
        let p = DVec3::new(0.3, -1.7, 2.9);
        let one = start(p, 4.1, 1e-9, DVec3::Y);
        for k in [-40, 40] {
            let s = 2f64.powi(k);
            assert_eq!(start(p * s, 4.1 * s, 1e-9 * s, DVec3::Y), one * s);
        }
    }

    #[test]
    fn shadow_rays_end_before_the_light() {
        for distance in [1e-300, 0.1, 1.0, 1e300] {
            assert!(before(distance) < distance);
        }
        assert_eq!(before(f64::INFINITY), f64::INFINITY);
    }
}
