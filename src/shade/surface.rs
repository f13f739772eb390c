//! A surface point with all its terms evaluated and its materials mixed.

use crate::scene::{Material, Model, Shadow, Term};
use crate::trace::Paint;
use glam::DVec3;
use std::sync::Arc;

/// How one point of a surface answers light. Colours are linear RGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The colour of ambient and diffuse light.
    pub color: DVec3,
    /// The share of the colour that is seen without light.
    pub ambient: f64,
    /// The share of the colour that is seen in light.
    pub diffuse: f64,
    /// The strength of the highlight.
    pub specular: f64,
    /// The exponent of the highlight, not negative.
    pub shininess: f64,
    /// The share of Blinn's highlight, the rest being Phong's: 0 or 1 where the materials agree.
    pub blinn: f64,
    /// The weight of the reflected ray.
    pub reflect: f64,
    /// The weight of the refracted ray.
    pub refract: f64,
    /// The index of refraction, positive.
    pub ior: f64,
    /// The share that reflects and refracts by Fresnel's equations: 0 or 1 where the materials agree.
    pub fresnel: f64,
    /// The absorption inside, per scene unit and channel.
    pub absorb: DVec3,
    /// The share of light that a shadow ray keeps when it crosses the surface.
    pub passes: f64,
    /// Which material it is, by address; of several, the one with the largest share.
    pub material: usize,
}

/// Which term of a material it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Property {
    Color,
    Ambient,
    Diffuse,
    Specular,
    Shininess,
    Reflect,
    Refract,
    Ior,
    Absorb,
}

/// What gives the terms of a material their values, one after the other.
pub(super) trait Terms {
    /// The value of a number.
    fn number(&mut self, property: Property, term: &Term<f64>) -> f64;

    /// The value of a colour.
    fn color(&mut self, property: Property, term: &Term<DVec3>) -> DVec3;
}

/// The values at a point.
struct At([f64; 3]);

impl Terms for At {
    fn number(&mut self, _: Property, term: &Term<f64>) -> f64 {
        term.at(self.0)
    }

    fn color(&mut self, _: Property, term: &Term<DVec3>) -> DVec3 {
        term.at(self.0)
    }
}

impl Surface {
    /// `material` at `point`, in the coordinates of the shape that was painted.
    pub fn new(material: &Arc<Material>, point: [f64; 3]) -> Self {
        Self::of_terms(material, &mut At(point))
    }

    /// `material` where its terms have these values. The order in which they are asked for is always the same.
    pub(super) fn of_terms(material: &Arc<Material>, terms: &mut impl Terms) -> Self {
        let m = material;
        let refract = terms.number(Property::Refract, &m.refract);
        let ior = terms.number(Property::Ior, &m.ior);
        let share = |holds: bool| if holds { 1.0 } else { 0.0 };
        Self {
            color: terms.color(Property::Color, &m.color),
            ambient: terms.number(Property::Ambient, &m.ambient),
            diffuse: terms.number(Property::Diffuse, &m.diffuse),
            specular: terms.number(Property::Specular, &m.specular),
            shininess: terms.number(Property::Shininess, &m.shininess).max(0.0),
            blinn: share(m.model == Model::Blinn),
            reflect: terms.number(Property::Reflect, &m.reflect),
            refract,
            // A pattern may give anything; what bends no light at all has an index of 1.
            ior: if ior > 0.0 && ior.is_finite() {
                ior
            } else {
                1.0
            },
            fresnel: share(m.fresnel),
            absorb: terms.color(Property::Absorb, &m.absorb).max(DVec3::ZERO),
            passes: match m.shadow {
                Shadow::Opaque => 0.0,
                Shadow::Tinted => refract,
                Shadow::None => 1.0,
            },
            material: Arc::as_ptr(m) as usize,
        }
    }

    /// The mix of `paints` by weight; terms on which they agree keep their bits. `None` where there is no paint.
    pub fn mixed(paints: &[Paint]) -> Option<Self> {
        let (first, rest) = paints.split_first()?;
        let mut mix = Self::new(first.material, first.point);
        let (mut sum, mut largest) = (first.weight, first.weight);
        for paint in rest.iter().filter(|p| p.weight > 0.0) {
            sum += paint.weight;
            let other = Self::new(paint.material, paint.point);
            let material = if paint.weight > largest {
                other.material
            } else {
                mix.material
            };
            largest = largest.max(paint.weight);
            mix = Self {
                material,
                ..mix.toward(&other, paint.weight / sum)
            };
        }
        Some(mix)
    }

    /// The point between `self` (share 0) and `other` (share 1).
    fn toward(&self, other: &Self, share: f64) -> Self {
        let number = |a: f64, b: f64| a + (b - a) * share;
        let color = |a: DVec3, b: DVec3| a + (b - a) * share;
        Self {
            color: color(self.color, other.color),
            ambient: number(self.ambient, other.ambient),
            diffuse: number(self.diffuse, other.diffuse),
            specular: number(self.specular, other.specular),
            shininess: number(self.shininess, other.shininess),
            blinn: number(self.blinn, other.blinn),
            reflect: number(self.reflect, other.reflect),
            refract: number(self.refract, other.refract),
            ior: number(self.ior, other.ior),
            fresnel: number(self.fresnel, other.fresnel),
            absorb: color(self.absorb, other.absorb),
            passes: number(self.passes, other.passes),
            material: self.material,
        }
    }

    /// Whether it sends reflected or refracted rays.
    pub fn sends_on(&self) -> bool {
        self.reflect != 0.0 || self.refract != 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn colored(color: DVec3) -> Arc<Material> {
        Arc::new(Material {
            color: Term::Constant(color),
            ..Material::default()
        })
    }

    fn paints<'a>(shares: &[(&'a Arc<Material>, f64)]) -> Vec<Paint<'a>> {
        let paint = |&(material, weight)| Paint {
            material,
            weight,
            point: [0.0; 3],
        };
        shares.iter().map(paint).collect()
    }

    #[test]
    fn equal_colours_stay_equal_for_any_shares() {
        let color = DVec3::new(0.1, 0.3, 0.7);
        let (a, b, c) = (colored(color), colored(color), colored(color));
        for i in 0..=100 {
            let w = f64::from(i) / 100.0;
            let mix = Surface::mixed(&paints(&[
                (&a, w / 3.0),
                (&b, w * 2.0 / 3.0),
                (&c, 1.0 - w),
            ]));
            assert_eq!(mix.unwrap().color, color);
        }
    }

    #[test]
    fn colours_mix_by_their_shares() {
        let (a, b, c) = (colored(DVec3::X), colored(DVec3::Y), colored(DVec3::Z));
        let mix = Surface::mixed(&paints(&[(&a, 0.5), (&b, 0.125), (&c, 0.375)])).unwrap();
        assert!(
            mix.color
                .abs_diff_eq(DVec3::new(0.5, 0.125, 0.375), 4.0 * f64::EPSILON)
        );
    }

    #[test]
    fn the_largest_share_names_the_material() {
        let (a, b) = (colored(DVec3::X), colored(DVec3::Y));
        let name = |x, y| {
            Surface::mixed(&paints(&[(&a, x), (&b, y)]))
                .unwrap()
                .material
        };
        assert_eq!(name(0.6, 0.4), Arc::as_ptr(&a) as usize);
        assert_eq!(name(0.4, 0.6), Arc::as_ptr(&b) as usize);
    }

    #[test]
    fn no_paint_is_no_surface() {
        assert_eq!(Surface::mixed(&[]), None);
    }

    #[test]
    fn an_impossible_index_of_refraction_bends_nothing() {
        for ior in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let m = Arc::new(Material {
                ior: Term::Constant(ior),
                ..Material::default()
            });
            assert_eq!(Surface::new(&m, [0.0; 3]).ior, 1.0);
        }
    }
}
