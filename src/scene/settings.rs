//! How the picture is made.

use std::ops::Range;

/// Which way rays find surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// Spheres, ellipsoids, planes, boxes, cylinders, capsules, tori, triangles, quadrilaterals and hard combinations of the convex ones in closed
    /// form, other convex shapes by tangents, the rest by certified sphere tracing in lanes, through combinations that are thinned
    /// out.
    Auto,
    /// Certified sphere tracing everywhere: hits are changes of sign.
    Certified,
    /// Convex shapes by tangents, the rest by certified sphere tracing; no closed forms.
    Convex,
    /// Hart's sphere tracing everywhere: t += |f| / lambda until |f| < epsilon or t > D.
    Sphere,
    /// Over-relaxed sphere tracing by [`Settings::omega`], Keinert et al. 2014.
    Relaxed,
    /// Automatic step size relaxation, Ban and Valasek 2023.
    AutoRelaxed,
    /// Enhanced steps along the estimated slope, Balint and Valasek 2018.
    Enhanced,
    /// Segment tracing by local constants, Galin et al. 2020.
    Segment,
    /// Two-sided Lipschitz bisection, as POV-Ray's isosurfaces.
    Bisect,
    /// Interval analysis on the ray, Mitchell 1990.
    Interval,
    /// Lines below the field and crossings of levels, in one traversal: forward inclusion, Aydinlilar and Zanni 2023.
    Probe,
    /// Interval bisection to the end, unpruned: the judge of the others.
    Reference,
}

impl Method {
    /// All methods, by their names in scripts.
    pub const ALL: [(&'static str, Self); 12] = [
        ("auto", Self::Auto),
        ("certified", Self::Certified),
        ("convex", Self::Convex),
        ("sphere", Self::Sphere),
        ("relaxed", Self::Relaxed),
        ("auto-relaxed", Self::AutoRelaxed),
        ("enhanced", Self::Enhanced),
        ("segment", Self::Segment),
        ("bisect", Self::Bisect),
        ("interval", Self::Interval),
        ("probe", Self::Probe),
        ("reference", Self::Reference),
    ];

    /// The method that scripts call `name`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL
            .iter()
            .find(|(word, _)| *word == name)
            .map(|(_, method)| *method)
    }

    /// The name in scripts.
    pub fn name(self) -> &'static str {
        Self::ALL
            .iter()
            .find(|(_, method)| *method == self)
            .map_or("", |(word, _)| word)
    }
}

/// Which pixels get all samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sampling {
    /// All of them.
    Even,
    /// Those that differ from a neighbour: in what is seen, in where it faces, or in colour. Of the others one sample in the
    /// middle is enough.
    Adaptive,
}

impl Sampling {
    /// All ways, by their names in scripts.
    pub const ALL: [(&'static str, Self); 2] = [("even", Self::Even), ("adaptive", Self::Adaptive)];

    /// The way that scripts call `name`.
    pub fn from_name(name: &str) -> Option<Self> {
        let mut all = Self::ALL.iter();
        all.find(|(word, _)| *word == name).map(|(_, way)| *way)
    }

    /// The name in scripts.
    pub fn name(self) -> &'static str {
        let mut all = Self::ALL.iter();
        all.find(|(_, way)| *way == self)
            .map_or("", |(word, _)| word)
    }
}

/// How the picture is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Width and height, in pixels.
    pub size: [u32; 2],
    /// Rays per pixel.
    pub samples: u32,
    /// Which pixels get as many.
    pub sampling: Sampling,
    /// How many times a ray may be reflected or refracted; what is deeper is black.
    pub depth: u32,
    /// How far from the surface a hit may be, in footprints of a pixel at its distance.
    pub tolerance: f64,
    /// How many steps a ray may take through one shape; then ranges decide, with the default method, or it is unknown.
    pub max_steps: u32,
    /// Which way rays find surfaces.
    pub method: Method,
    /// How much longer the steps of [`Method::Relaxed`] are than what is known to be free; one of [`Settings::OMEGAS`].
    pub omega: f64,
    /// What random choices start from.
    pub seed: u64,
}

impl Settings {
    /// The largest width or height of a picture, in pixels; a square of it takes 3 GiB of film.
    pub const MAX_SIDE: u32 = 16_384;

    /// What [`Settings::omega`] may be: from 2 on, the balls of two places in a row overlap only where the field grows.
    pub const OMEGAS: Range<f64> = 1.0..2.0;
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            size: [640, 360],
            samples: 1,
            sampling: Sampling::Even,
            depth: 8,
            tolerance: 0.1,
            max_steps: 1024,
            method: Method::Auto,
            omega: 1.6,
            seed: 0,
        }
    }
}
