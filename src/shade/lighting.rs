//! What lighting reads of surfaces, in columns.

use super::Surface;
use super::surface::Property;

/// How many numbers of a surface lighting reads.
pub const LIGHTING: usize = 8;

/// What lighting reads of surfaces, side by side.
#[derive(Clone, Copy)]
pub struct Lighting<'a> {
    /// The colour, by channel.
    pub color: [&'a [f64]; 3],
    /// The share of it that is seen without light.
    pub ambient: &'a [f64],
    /// The share of it that is seen in light.
    pub diffuse: &'a [f64],
    /// The strength of the highlight.
    pub specular: &'a [f64],
    /// Its exponent.
    pub shininess: &'a [f64],
    /// The share of Blinn's highlight.
    pub blinn: &'a [f64],
}

impl<'a> Lighting<'a> {
    /// These columns, in the order of [`row`].
    #[inline(always)]
    pub fn of(columns: [&'a [f64]; LIGHTING]) -> Self {
        let [r, g, b, ambient, diffuse, specular, shininess, blinn] = columns;
        Self {
            color: [r, g, b],
            ambient,
            diffuse,
            specular,
            shininess,
            blinn,
        }
    }
}

/// What lighting reads of a surface.
pub fn row(s: &Surface) -> [f64; LIGHTING] {
    let [r, g, b] = s.color.to_array();
    [
        r,
        g,
        b,
        s.ambient,
        s.diffuse,
        s.specular,
        s.shininess,
        s.blinn,
    ]
}

/// The place in a [`row`] of the first number of a property; none if lighting does not read it.
pub fn place(property: Property) -> Option<usize> {
    match property {
        Property::Color => Some(0),
        Property::Ambient => Some(3),
        Property::Diffuse => Some(4),
        Property::Specular => Some(5),
        Property::Shininess => Some(6),
        Property::Reflect | Property::Refract | Property::Ior | Property::Absorb => None,
    }
}

/// Where there is no surface, the colour is that of the sky, and all of it is seen.
pub const BACKDROP: [f64; LIGHTING] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0];
