//! The camera: which ray belongs to which place of the picture.

use glam::DVec3;

/// How the camera sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Rays leave the eye; `fov` is the full vertical angle of view in radians, in (0, pi).
    Perspective {
        /// The full vertical angle of view, in radians.
        fov: f64,
    },
    /// Rays are parallel; `height` is the full height of the picture in scene units.
    Orthographic {
        /// The full height of the picture, in scene units.
        height: f64,
    },
}

/// The point of view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where the camera stands.
    pub eye: DVec3,
    /// What it looks at.
    pub at: DVec3,
    /// Which direction is up in the picture; need not be orthogonal to the line of sight.
    pub up: DVec3,
    /// How it sees.
    pub projection: Projection,
    /// Half the width and height of the screen at distance 1, where the script sets them itself.
    pub screen: Option<[f64; 2]>,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            eye: DVec3::new(4.0, 3.0, 6.0),
            at: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Perspective {
                fov: 40f64.to_radians(),
            },
            screen: None,
        }
    }
}
