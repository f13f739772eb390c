//! Materials: how a surface answers light. Colours are linear RGB.

use super::Graph;
use glam::DVec3;
use std::sync::Arc;

/// A term of a material: the same everywhere, or a pattern over the surface.
#[derive(Clone, Debug)]
pub enum Term<T> {
    /// The same everywhere.
    Constant(T),
    /// A function of the point, in the coordinates of the shape that was painted: three outputs for a colour, one for
    /// a number.
    Pattern(Arc<Graph>),
}

impl Term<f64> {
    /// The value at `p`.
    pub fn at(&self, p: [f64; 3]) -> f64 {
        match self {
            Self::Constant(x) => *x,
            Self::Pattern(graph) => graph.values(p).0[0],
        }
    }

    /// Whether it is surely zero everywhere.
    pub fn is_zero(&self) -> bool {
        matches!(self, Self::Constant(x) if *x == 0.0)
    }
}

impl Term<DVec3> {
    /// The value at `p`; a pattern with one output gives a grey.
    pub fn at(&self, p: [f64; 3]) -> DVec3 {
        match self {
            Self::Constant(c) => *c,
            Self::Pattern(graph) => match graph.values(p) {
                ([r, g, b], 3) => DVec3::new(r, g, b),
                ([grey, ..], _) => DVec3::splat(grey),
            },
        }
    }

    /// Whether it is surely black everywhere.
    pub fn is_zero(&self) -> bool {
        matches!(self, Self::Constant(c) if *c == DVec3::ZERO)
    }
}

/// How highlights are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// (R.V)^n with R the mirrored light. Source: Phong 1975.
    Phong,
    /// (N.H)^n with H half way between light and viewer. Source: Blinn 1977.
    Blinn,
}

/// What light does behind the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shadow {
    /// Casts a full shadow.
    Opaque,
    /// Lets light pass by `refract` at each surface and by absorption between them, along the straight ray.
    Tinted,
    /// Casts no shadow.
    None,
}

/// How a surface answers light.
#[derive(Clone, Debug)]
pub struct Material {
    /// The name in the script.
    pub name: String,
    /// The colour of ambient and diffuse light.
    pub color: Term<DVec3>,
    /// The share of the colour that is seen without light.
    pub ambient: Term<f64>,
    /// The share of the colour that is seen in light (Lambert).
    pub diffuse: Term<f64>,
    /// The strength of the highlight, which has the light's colour.
    pub specular: Term<f64>,
    /// The exponent of the highlight.
    pub shininess: Term<f64>,
    /// How highlights are computed.
    pub model: Model,
    /// The weight of the reflected ray.
    pub reflect: Term<f64>,
    /// The weight of the refracted ray.
    pub refract: Term<f64>,
    /// The index of refraction.
    pub ior: Term<f64>,
    /// Whether reflection and refraction share `reflect + refract` by Fresnel's equations.
    pub fresnel: bool,
    /// The absorption inside, per scene unit and channel (Beer-Lambert).
    pub absorb: Term<DVec3>,
    /// What light does behind the surface.
    pub shadow: Shadow,
}

impl Material {
    /// Whether any term is a pattern, so that the material differs from point to point.
    pub fn has_patterns(&self) -> bool {
        let numbers = [
            &self.ambient,
            &self.diffuse,
            &self.specular,
            &self.shininess,
            &self.reflect,
            &self.refract,
            &self.ior,
        ];
        let colors = [&self.color, &self.absorb];
        numbers.iter().any(|t| matches!(t, Term::Pattern(_)))
            || colors.iter().any(|t| matches!(t, Term::Pattern(_)))
    }
}

impl Default for Material {
    fn default() -> Self {
        let number = Term::Constant;
        Self {
            name: "default".into(),
            // #ccc in sRGB.
            color: Term::Constant(DVec3::splat(0.603_827_338_855_337_8)),
            ambient: number(0.1),
            diffuse: number(0.8),
            specular: number(0.2),
            shininess: number(32.0),
            model: Model::Phong,
            reflect: number(0.0),
            refract: number(0.0),
            ior: number(1.5),
            fresnel: false,
            absorb: Term::Constant(DVec3::ZERO),
            shadow: Shadow::Opaque,
        }
    }
}
