//! What is seen where a ray meets nothing.

use crate::scene::Sky;
use glam::DVec3;

/// The colour of the sky along a unit `direction`: the horizon's at and below it, then with the height `y` smoothly
/// (`3 y^2 - 2 y^3`, without a kink at the horizon) to the zenith's.
#[inline(always)]
pub fn radiance(sky: &Sky, direction: DVec3) -> DVec3 {
    let y = direction.y.clamp(0.0, 1.0);
    sky.horizon + (sky.zenith - sky.horizon) * (y * y * (3.0 - 2.0 * y))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sky_turns_from_horizon_to_zenith() {
        let sky = Sky {
            horizon: DVec3::X,
            zenith: DVec3::Z,
        };
        assert_eq!(radiance(&sky, DVec3::Z), DVec3::X);
        assert_eq!(radiance(&sky, DVec3::NEG_Y), DVec3::X);
        assert_eq!(radiance(&sky, DVec3::Y), DVec3::Z);
        let middle = radiance(&sky, DVec3::new(0.75f64.sqrt(), 0.5, 0.0));
        assert_eq!(middle, DVec3::new(0.5, 0.0, 0.5));
    }

    #[test]
    fn uniform_sky_is_uniform_to_the_bit() {
        let sky = Sky::uniform(DVec3::new(0.1, 0.2, 0.3));
        for y in [-1.0, 0.0, 0.123, 0.77, 1.0] {
            let direction = DVec3::new((1.0f64 - y * y).sqrt(), y, 0.0);
            assert_eq!(radiance(&sky, direction), sky.horizon);
        }
    }
}
