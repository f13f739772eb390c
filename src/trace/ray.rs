//! Rays.

use glam::DVec3;

/// How wide a pixel is along a ray: `at_origin + spread * t`, in scene units. Secondary rays carry it on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// The width at the ray's origin, in scene units.
    pub at_origin: f64,
    /// By how much it grows with each scene unit.
    pub spread: f64,
}

impl Footprint {
    /// The width at distance `t`.
    pub fn at(&self, t: f64) -> f64 {
        self.at_origin + self.spread * t
    }
}

/// A half-line that is traced up to `t_max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts. A ray that starts on a surface leaves it first: that point is no hit.
    pub origin: DVec3,
    /// Where it goes, of length 1.
    pub direction: DVec3,
    /// How far it is followed, in scene units; may be infinite.
    pub t_max: f64,
    /// How wide its pixel is.
    pub footprint: Footprint,
}

impl Ray {
    /// The point at distance `t`.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }
}
