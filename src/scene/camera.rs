//! The camera: which ray belongs to which place of the picture.

use crate::catalogue::Bounds;
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

impl Camera {
    /// The width and height of a pixel on the screen, for a picture of `size` (width and height in pixels): in units of
    /// the distance to the screen for a perspective, in scene units otherwise. A picture of one column or row is as wide
    /// or high as one of two.
    pub fn pixel(&self, size: [u32; 2]) -> [f64; 2] {
        let half_height = match self.projection {
            Projection::Perspective { fov } => libm::tan(fov / 2.0),
            Projection::Orthographic { height } => height / 2.0,
        };
        let [columns, rows] = size.map(|n| f64::from(n.max(2) - 1));
        let [s, t] = self
            .screen
            .unwrap_or([half_height * columns / rows, half_height]);
        [2.0 * s / columns, 2.0 * t / rows]
    }

    /// Whether all rays start outside of a box, which is finite.
    pub fn is_outside(&self, bounds: &Bounds) -> bool {
        let (low, high) = (
            DVec3::from_array(bounds.low),
            DVec3::from_array(bounds.high),
        );
        match self.projection {
            Projection::Perspective { .. } => {
                self.eye.cmplt(low).any() || self.eye.cmpgt(high).any()
            }
            // Rays start on a plane, which the box has to lie before.
            Projection::Orthographic { .. } => {
                let forward = self.at - self.eye;
                let nearest = (low - self.eye) * forward;
                let nearest = nearest.min((high - self.eye) * forward);
                nearest.element_sum() > 0.0
            }
        }
    }
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
