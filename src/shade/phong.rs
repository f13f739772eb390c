//! Local illumination: ambient light, Lambert's diffuse light, and the highlights of Phong and Blinn.
//!
//! `I = Ka + sum_i [Kd (L_i.N) + Ks (R_i.V)^n] I_i` with `Ka = ambient color`, `Kd = diffuse color`, `Ks = specular`.
//! Sources: Lambert 1760; Phong 1975; Blinn 1977.

use crate::trace::vector::unit_or;
use glam::DVec3;

/// The cosines that decide what a surface shows of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cosines {
    /// That of the angle between light and normal, L.N.
    pub light: f64,
    /// That of the angle between the mirrored light and the viewer, R.V, for Phong's highlight.
    pub mirror: f64,
}

impl Cosines {
    /// The cosines between vectors of length 1: `normal` on the viewer's side, `toward` the light, `view` towards the viewer.
    #[inline(always)]
    pub fn new(normal: DVec3, toward: DVec3, view: DVec3) -> Self {
        let light = normal.dot(toward);
        Self {
            light,
            mirror: (normal * (2.0 * light) - toward).dot(view),
        }
    }
}

/// The cosine of the angle between the normal and half way from light to viewer, N.H, for Blinn's highlight; of the vectors of
/// [`Cosines::new`].
#[inline(always)]
pub fn halfway(normal: DVec3, toward: DVec3, view: DVec3) -> f64 {
    // Light opposite to the viewer has nothing half way.
    normal.dot(unit_or(toward + view, DVec3::ZERO))
}

/// The share of a light's radiance that the surface sends to the viewer in a channel of this `color`:
/// `Kd (L.N) + Ks (R.V)^n`, where `shine` is the second term. Zero where the light is behind the surface.
#[inline(always)]
pub fn reflectance(color: f64, diffuse: f64, light: f64, shine: f64) -> f64 {
    let seen = color * (diffuse * light) + shine;
    if light > 0.0 { seen } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::super::Surface;
    use super::super::highlight::{GROUP, highlights};
    use super::*;
    use crate::scene::{Material, Model, Term};
    use std::sync::Arc;

    fn reflectance(surface: &Surface, normal: DVec3, toward: DVec3, view: DVec3) -> DVec3 {
        let cosines = Cosines::new(normal, toward, view);
        let [mirror, halfway, shininess, blinn] = [
            cosines.mirror,
            super::halfway(normal, toward, view),
            surface.shininess,
            surface.blinn,
        ]
        .map(|number| [number; GROUP]);
        let shine = surface.specular * highlights([&mirror, &halfway], &shininess, &blinn)[0];
        surface
            .color
            .map(|color| super::reflectance(color, surface.diffuse, cosines.light, shine))
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
}
