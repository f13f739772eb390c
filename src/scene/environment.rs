//! What surrounds the shapes: sky and fog. Colours are linear RGB.

use glam::DVec3;

/// What is seen where a ray meets nothing: a colour at the horizon that turns into another at the zenith.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky {
    /// The colour at and below the horizon.
    pub horizon: DVec3,
    /// The colour straight up.
    pub zenith: DVec3,
}

impl Sky {
    /// The same colour everywhere.
    pub fn uniform(color: DVec3) -> Self {
        Self {
            horizon: color,
            zenith: color,
        }
    }
}

impl Default for Sky {
    fn default() -> Self {
        Self::uniform(DVec3::ZERO)
    }
}

/// Haze of even density: over a distance d, the share exp(-density d) of the light passes and the fog's colour takes
/// the rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// The colour of the fog.
    pub color: DVec3,
    /// How fast it thickens, per scene unit; not negative.
    pub density: f64,
}
