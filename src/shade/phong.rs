//! Local illumination: ambient light, Lambert's diffuse light, and the highlights of Phong and Blinn.
//!
//! `I = Ka + sum_i [Kd (L_i.N) + Ks (R_i.V)^n] I_i` with `Ka = ambient color`, `Kd = diffuse color`, `Ks = specular`.
//! Sources: Lambert 1760; Phong 1975; Blinn 1977.

use super::Surface;
use crate::num::Number;
use glam::DVec3;

/// What the surface shows without any light.
pub fn ambient(surface: &Surface) -> DVec3 {
    surface.color * surface.ambient
}

/// The cosines that decide what a surface shows of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cosines {
    /// That of the angle between light and normal, L.N.
    pub light: f64,
    /// That of the angle between the mirrored light and the viewer, R.V, for Phong's highlight.
    pub mirror: f64,
    /// That of the angle between the normal and half way from light to viewer, N.H, for Blinn's.
    pub halfway: f64,
}

impl Cosines {
    /// The cosines between vectors of length 1: `normal` on the viewer's side, `toward` the light, `view` towards the viewer.
    #[inline(always)]
    pub fn new(normal: DVec3, toward: DVec3, view: DVec3) -> Self {
        let light = normal.dot(toward);
        let sum = toward + view;
        let scale = 1.0 / sum.length();
        // Light opposite to the viewer has nothing half way.
        let is_halfway = (scale > 0.0) & (scale < f64::INFINITY);
        let halfway = normal.dot(sum * scale);
        Self {
            light,
            mirror: (normal * (2.0 * light) - toward).dot(view),
            halfway: if is_halfway { halfway } else { 0.0 },
        }
    }
}

/// The share of a light's radiance that the surface sends to the viewer: `Kd (L.N) + Ks (R.V)^n`. Zero where the light is
/// behind the surface.
pub fn reflectance(surface: &Surface, cosines: &Cosines) -> DVec3 {
    if cosines.light.is_nan() || cosines.light <= 0.0 {
        return DVec3::ZERO;
    }
    let diffuse = surface.color * (surface.diffuse * cosines.light);
    diffuse + DVec3::splat(surface.specular * highlight(surface, cosines))
}

/// The highlight of a light in front of the surface, in [0, 1].
fn highlight(surface: &Surface, cosines: &Cosines) -> f64 {
    if surface.specular == 0.0 {
        return 0.0;
    }
    let phong = || lobe(cosines.mirror, surface.shininess);
    let blinn = || lobe(cosines.halfway, surface.shininess);
    match surface.blinn {
        0.0 => phong(),
        1.0 => blinn(),
        share => phong() * (1.0 - share) + blinn() * share,
    }
}

/// Highlights below `exp` of this are 0: 2^-53, what rounding would take from a full one anyway.
const FAINTEST_LOG: f64 = -36.7;

/// `cosine^exponent` in front, 0 behind; also where the exponent is 0, for which a plain power would give 0^0 = 1.
fn lobe(cosine: f64, exponent: f64) -> f64 {
    // ln c <= c - 1 bounds the power from above: most points need none, a tenth of the time of three spheres.
    if cosine > 0.0 && exponent * (cosine - 1.0) > FAINTEST_LOG {
        power(cosine.min(1.0), exponent)
    } else {
        0.0
    }
}

/// `x^exponent`; for whole exponents, as most are, by a few multiplications.
fn power(x: f64, exponent: f64) -> f64 {
    if exponent <= 1024.0 && exponent.fract() == 0.0 {
        Number::powi(x, exponent as i32)
    } else {
        libm::pow(x, exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Material, Model, Term};
    use std::sync::Arc;

    fn reflectance(surface: &Surface, normal: DVec3, toward: DVec3, view: DVec3) -> DVec3 {
        super::reflectance(surface, &Cosines::new(normal, toward, view))
    }

    fn surface(diffuse: f64, specular: f64, shininess: f64, model: Model) -> Surface {
        let material = Arc::new(Material {
            color: Term::Constant(DVec3::new(1.0, 0.5, 0.25)),
            diffuse: Term::Constant(diffuse),
            specular: Term::Constant(specular),
            shininess: Term::Constant(shininess),
            model,
            ..Material::default()
        });
        Surface::new(&material, [0.0; 3])
    }

    /// The unit vector at this angle from the normal (0, 1, 0), in degrees.
    fn at(degrees: f64) -> DVec3 {
        let a = degrees.to_radians();
        DVec3::new(a.sin(), a.cos(), 0.0)
    }

    #[test]
    fn diffuse_light_falls_with_the_cosine() {
        let matt = surface(0.8, 0.0, 1.0, Model::Phong);
        for degrees in [0.0, 10.0, 45.0, 60.0, 89.0] {
            let seen = reflectance(&matt, DVec3::Y, at(degrees), at(-30.0));
            let law = matt.color * (0.8 * degrees.to_radians().cos());
            assert!(seen.abs_diff_eq(law, 1e-15), "{degrees} degrees");
        }
    }

    #[test]
    fn phong_peaks_in_the_mirror_direction_and_falls_by_its_exponent() {
        for exponent in [1.0, 32.0, 500.0] {
            let shiny = surface(0.0, 0.6, exponent, Model::Phong);
            for off in [0.0f64, 5.0, 20.0] {
                let seen = reflectance(&shiny, DVec3::Y, at(40.0), at(-40.0 + off));
                let law = 0.6 * off.to_radians().cos().powf(exponent);
                assert!((seen.x - law).abs() < 1e-13, "{exponent}, {off}");
                assert_eq!(seen, DVec3::splat(seen.x), "highlights are white");
            }
        }
    }

    #[test]
    fn blinn_measures_from_the_halfway_vector() {
        let shiny = surface(0.0, 0.6, 50.0, Model::Blinn);
        for off in [0.0f64, 6.0, 20.0] {
            let seen = reflectance(&shiny, DVec3::Y, at(40.0), at(-40.0 + off));
            let law = 0.6 * (off / 2.0).to_radians().cos().powf(50.0);
            assert!((seen.x - law).abs() < 1e-13, "{off}");
        }
    }

    #[test]
    fn nothing_shines_behind_the_surface() {
        for model in [Model::Phong, Model::Blinn] {
            for exponent in [0.0, 1.0, 32.0] {
                let shiny = surface(0.8, 0.5, exponent, model);
                for toward in [at(90.0), at(120.0), at(180.0), DVec3::NAN] {
                    // At 90 degrees the cosine is 6e-17, not 0.
                    let seen =
                        reflectance(&shiny, DVec3::Y, toward.with_y(toward.y - 1e-16), at(-45.0));
                    assert_eq!(seen, DVec3::ZERO);
                }
            }
        }
    }

    #[test]
    fn exponent_zero_has_no_highlight_away_from_the_mirror_side() {
        let flat = surface(0.0, 0.5, 0.0, Model::Phong);
        let seen = |view| reflectance(&flat, DVec3::Y, at(80.0), view).x;
        assert_eq!(seen(at(-80.0)), 0.5);
        assert_eq!(seen(at(80.0)), 0.0, "R.V is negative: 0, and no NaN");
    }

    #[test]
    fn light_opposite_to_the_viewer_gives_no_nan() {
        let shiny = surface(0.8, 0.5, 32.0, Model::Blinn);
        let seen = reflectance(&shiny, DVec3::Y, at(60.0), -at(60.0));
        assert!(seen.is_finite());
    }

    #[test]
    fn ambient_light_needs_no_light() {
        let matt = surface(0.8, 0.0, 1.0, Model::Phong);
        assert_eq!(ambient(&matt), matt.color * 0.1);
    }
}
