//! How much light a smooth boundary of two clear media reflects.

use super::refract::transmitted_cosine;

/// The reflected share of unpolarised light that comes at an angle with this `cosine` in [0, 1] from a medium with index
/// `n1` to one with `n2`; the rest is transmitted. In [0, 1], continuous up to 1 at the critical angle.
/// Source: Fresnel 1823; the mean of both polarisations.
pub fn reflected_share(cosine: f64, n1: f64, n2: f64) -> f64 {
    share(cosine, transmitted_cosine(cosine, n1, n2), n1, n2)
}

/// As [`reflected_share`], where the cosine behind the boundary is known; it is no number where nothing is transmitted.
/// Without branches, to serve in lanes.
#[inline(always)]
pub(super) fn share(cosine: f64, transmitted: f64, n1: f64, n2: f64) -> f64 {
    // At least one cosine is positive here: `n1 != n2`, and where the outer one is 0, light bends towards the normal.
    let across = (n1 * cosine - n2 * transmitted) / (n1 * cosine + n2 * transmitted);
    let along = (n2 * cosine - n1 * transmitted) / (n2 * cosine + n1 * transmitted);
    let mean = 0.5 * (across * across + along * along);
    let mean = if mean < 1.0 { mean } else { 1.0 };
    if n1 == n2 { 0.0 } else { mean }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(degrees: f64, n1: f64, n2: f64) -> f64 {
        reflected_share(degrees.to_radians().cos(), n1, n2)
    }

    #[test]
    fn glass_reflects_four_per_cent_head_on() {
        assert!((at(0.0, 1.0, 1.5) - 0.04).abs() < 1e-15);
        assert!((at(0.0, 1.5, 1.0) - 0.04).abs() < 1e-15);
    }

    #[test]
    fn reflected_and_transmitted_power_sum_to_one() {
        // T = (n2 cos b) / (n1 cos a) t^2 from the amplitudes of transmission, apart from those of reflection.
        for (n1, n2) in [(1.0, 1.5), (1.5, 1.0), (1.33, 1.5), (1.0, 2.4)] {
            for degrees in [0.0, 10.0, 30.0, 41.0] {
                let a = f64::to_radians(degrees);
                let sine = n1 / n2 * a.sin();
                if sine >= 1.0 {
                    continue;
                }
                let (c1, c2) = (a.cos(), sine.asin().cos());
                let across = 2.0 * n1 * c1 / (n1 * c1 + n2 * c2);
                let along = 2.0 * n1 * c1 / (n2 * c1 + n1 * c2);
                let transmitted = n2 * c2 / (n1 * c1) * 0.5 * (across * across + along * along);
                let sum = at(degrees, n1, n2) + transmitted;
                assert!((sum - 1.0).abs() < 1e-14, "{n1} {n2} {degrees}: {sum}");
            }
        }
    }

    #[test]
    fn brewsters_angle_halves_what_is_reflected() {
        // There the light polarised along the plane is not reflected at all.
        let brewster = 1.5f64.atan();
        let across = ((1.0 - 1.5 * 1.5) / (1.0 + 1.5 * 1.5f64)).powi(2);
        assert!((at(brewster.to_degrees(), 1.0, 1.5) - across / 2.0).abs() < 1e-15);
    }

    #[test]
    fn share_reaches_one_at_the_critical_angle_without_a_jump() {
        let critical = (1.0f64 / 1.5).asin().to_degrees();
        assert!(at(critical, 1.5, 1.0) > 1.0 - 1e-6);
        // Series at the critical angle c: 1 - R = 2 (n + 1/n) sqrt(2 n cos(c) off) / cos(c) + O(off).
        let (n, c) = (1.5f64, critical.to_radians().cos());
        for off in [1e-7f64, 1e-3] {
            let missing = 1.0 - at(critical - off, 1.5, 1.0);
            let series = 2.0 * (n + 1.0 / n) * (2.0 * n * c * off.to_radians()).sqrt() / c;
            assert!((missing / series - 1.0).abs() < 0.03, "{off}: {missing}");
            assert_eq!(at(critical + off, 1.5, 1.0), 1.0);
        }
    }

    #[test]
    fn grazing_light_is_reflected() {
        assert_eq!(reflected_share(0.0, 1.0, 1.5), 1.0);
        assert_eq!(reflected_share(0.0, 1.5, 1.0), 1.0);
        assert_eq!(reflected_share(0.0, 1.5, 1.5), 0.0);
    }
}
