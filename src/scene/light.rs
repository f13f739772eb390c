//! Lights.

use glam::DVec3;

/// How a light weakens with distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Falloff {
    /// Not at all.
    None,
    /// By 1 / d^2, with d in scene units.
    InverseSquare,
}

/// Where light comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// From infinitely far.
    Directional {
        /// The unit vector from any surface towards the light.
        toward: DVec3,
    },
    /// From a point, alike in all directions.
    Point {
        /// Where the light stands.
        position: DVec3,
        /// How it weakens.
        falloff: Falloff,
    },
    /// From a point, in a cone.
    Spot {
        /// Where the light stands.
        position: DVec3,
        /// The unit vector along the middle of the cone, away from the light.
        axis: DVec3,
        /// The angle between the axis and where the light ends, in radians.
        outer: f64,
        /// The angle between the axis and where the light starts to weaken, in radians; at most `outer`.
        inner: f64,
        /// How it weakens.
        falloff: Falloff,
    },
}

/// A light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where light comes from.
    pub source: Source,
    /// Its colour times its intensity, linear RGB.
    pub radiance: DVec3,
}

impl Light {
    /// Whether it is not black.
    pub fn shines(&self) -> bool {
        self.radiance != DVec3::ZERO
    }
}
