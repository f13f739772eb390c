//! The refracted direction.

use crate::trace::vector::{select, unit_or};
use glam::DVec3;

/// The direction behind a surface between media with indices `n1` (here) and `n2` (there), by Snell's law
/// `n1 sin a = n2 sin b`; `None` where all light is reflected. Unit vectors, with `normal` against `incident`.
pub fn refracted(incident: DVec3, normal: DVec3, n1: f64, n2: f64) -> Option<DVec3> {
    let cosine = (-incident.dot(normal)).clamp(0.0, 1.0);
    let transmitted = transmitted_cosine(cosine, n1, n2);
    let bends = !transmitted.is_nan();
    bends.then(|| bent(incident, normal, (n1, n2), (cosine, transmitted)))
}

/// As [`refracted`], where the cosines before and behind the surface are known. Without branches, to serve in lanes.
#[inline(always)]
pub(super) fn bent(
    incident: DVec3,
    normal: DVec3,
    (n1, n2): (f64, f64),
    (cosine, transmitted): (f64, f64),
) -> DVec3 {
    let eta = n1 / n2;
    let direction = incident * eta + normal * (eta * cosine - transmitted);
    select(n1 == n2, incident, unit_or(direction, -normal))
}

/// The cosine behind a surface for the `cosine` in [0, 1] before it, between media with indices `n1` and `n2`; not a number
/// from the critical angle on, where `sin b = 1`. Without branches, to serve in lanes.
#[inline(always)]
pub(super) fn transmitted_cosine(cosine: f64, n1: f64, n2: f64) -> f64 {
    let eta = n1 / n2;
    let sine_squared = eta * eta * (1.0 - cosine * cosine);
    let bends = (sine_squared < 1.0) | (n1 == n2);
    let transmitted = (1.0 - sine_squared).sqrt();
    if bends { transmitted } else { f64::NAN }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The incident direction at this angle from the normal (0, 1, 0).
    fn incident(degrees: f64) -> DVec3 {
        let a = degrees.to_radians();
        DVec3::new(a.sin(), -a.cos(), 0.0)
    }

    #[test]
    fn sines_stand_as_the_indices() {
        for (n1, n2) in [(1.0, 1.5), (1.5, 1.0), (1.5, 1.333), (1.0, 2.4)] {
            for degrees in [0.0, 1.0, 20.0, 40.0] {
                let i = incident(degrees);
                let t = refracted(i, DVec3::Y, n1, n2).unwrap();
                assert!((n1 * i.x - n2 * t.x).abs() < 1e-15, "{n1} {n2} {degrees}");
                assert!((t.length() - 1.0).abs() < 1e-15);
                assert!(t.y < 0.0);
            }
        }
    }

    #[test]
    fn light_is_reflected_totally_beyond_the_critical_angle() {
        let critical = (1.0f64 / 1.5).asin().to_degrees();
        assert!((critical - 41.8103).abs() < 1e-4);
        for off in [1e-7, 1e-3, 1.0] {
            let through = |degrees| refracted(incident(degrees), DVec3::Y, 1.5, 1.0);
            assert!(through(critical - off).is_some_and(DVec3::is_finite));
            assert_eq!(through(critical + off), None);
        }
        let at = refracted(incident(critical), DVec3::Y, 1.5, 1.0);
        assert!(at.is_none_or(|t| t.is_finite() && t.y.abs() < 1e-7));
    }

    #[test]
    fn equal_indices_keep_the_bits_of_the_direction() {
        let i = incident(33.3);
        assert_eq!(refracted(i, DVec3::Y, 1.5, 1.5), Some(i));
    }

    #[test]
    fn the_way_back_is_the_way_in() {
        let i = incident(37.0);
        let t = refracted(i, DVec3::Y, 1.0, 1.5).unwrap();
        let back = refracted(-t, DVec3::NEG_Y, 1.5, 1.0).unwrap();
        assert!(back.abs_diff_eq(-i, 1e-15));
    }
}
