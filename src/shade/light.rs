//! Light as it arrives at a point.

use crate::scene::{Falloff, Light, Source};
use glam::DVec3;

/// A light, ready to shine on many points.
#[derive(Clone, Copy, Debug)]
pub struct Lamp {
    light: Light,
    /// The cosines of the outer and inner angle of a spot.
    edge: [f64; 2],
}

/// The light that arrives at a point, if nothing is in the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// The unit vector towards the light.
    pub toward: DVec3,
    /// Its colour and strength, linear RGB.
    pub radiance: DVec3,
    /// Where the light stands; `None` where it is infinitely far.
    pub position: Option<DVec3>,
}

impl Lamp {
    /// The lamp of a scene's light.
    pub fn new(light: Light) -> Self {
        let edge = match light.source {
            Source::Spot { outer, inner, .. } => [libm::cos(outer), libm::cos(inner)],
            Source::Directional { .. } | Source::Point { .. } => [-1.0; 2],
        };
        Self { light, edge }
    }

    /// What arrives at `point`: `None` where it is black, and at the very place of the light, where it has no direction.
    pub fn at(&self, point: DVec3) -> Option<Arrival> {
        let arrival = match self.light.source {
            Source::Directional { toward } => Some(Arrival {
                toward,
                radiance: self.light.radiance,
                position: None,
            }),
            Source::Point { position, falloff } => self.from(position, falloff, point),
            Source::Spot {
                position,
                axis,
                falloff,
                ..
            } => self.from(position, falloff, point).map(|arrival| Arrival {
                radiance: arrival.radiance * self.share(-arrival.toward.dot(axis)),
                ..arrival
            }),
        }?;
        (arrival.radiance != DVec3::ZERO).then_some(arrival)
    }

    /// What arrives at `point` from `position`.
    fn from(&self, position: DVec3, falloff: Falloff, point: DVec3) -> Option<Arrival> {
        let way = position - point;
        let distance = way.length();
        let strength = match falloff {
            Falloff::None => 1.0,
            Falloff::InverseSquare => 1.0 / (distance * distance),
        };
        (distance > 0.0 && strength.is_finite()).then(|| Arrival {
            toward: way / distance,
            radiance: self.light.radiance * strength,
            position: Some(position),
        })
    }

    /// The share of a spot's light at an angle from its axis with this `cosine`: 1 inside the inner angle, 0 outside of
    /// the outer, with continuous slope between (smoothstep of the cosine).
    fn share(&self, cosine: f64) -> f64 {
        let [outer, inner] = self.edge;
        if cosine >= inner {
            return 1.0;
        }
        if cosine <= outer {
            return 0.0;
        }
        let x = (cosine - outer) / (inner - outer);
        x * x * (3.0 - 2.0 * x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spot(inner: f64, outer: f64) -> Lamp {
        Lamp::new(Light {
            source: Source::Spot {
                position: DVec3::new(0.0, 2.0, 0.0),
                axis: DVec3::NEG_Y,
                outer: outer.to_radians(),
                inner: inner.to_radians(),
                falloff: Falloff::None,
            },
            radiance: DVec3::ONE,
        })
    }

    fn point(falloff: Falloff) -> Lamp {
        Lamp::new(Light {
            source: Source::Point {
                position: DVec3::new(0.0, 2.0, 0.0),
                falloff,
            },
            radiance: DVec3::new(4.0, 2.0, 1.0),
        })
    }

    /// The point two units below the spot whose direction is this far from its axis.
    fn below(degrees: f64) -> DVec3 {
        DVec3::new(2.0 * degrees.to_radians().tan(), 0.0, 0.0)
    }

    #[test]
    fn inverse_square_quarters_at_twice_the_distance() {
        let lamp = point(Falloff::InverseSquare);
        let at = |y: f64| lamp.at(DVec3::new(0.0, y, 0.0)).unwrap().radiance;
        assert_eq!(at(1.0), DVec3::new(4.0, 2.0, 1.0));
        assert_eq!(at(0.0), at(1.0) / 4.0);
        assert_eq!(at(-2.0), at(1.0) / 16.0);
    }

    #[test]
    fn without_falloff_distance_does_not_matter() {
        let lamp = point(Falloff::None);
        let at = |y: f64| lamp.at(DVec3::new(0.0, y, 0.0)).unwrap().radiance;
        assert_eq!(at(1.0), at(-1e6));
    }

    #[test]
    fn at_its_own_place_a_light_gives_nothing() {
        for falloff in [Falloff::None, Falloff::InverseSquare] {
            assert_eq!(point(falloff).at(DVec3::new(0.0, 2.0, 0.0)), None);
        }
        let near = DVec3::new(1e-200, 2.0, 0.0);
        assert_eq!(
            point(Falloff::InverseSquare).at(near),
            None,
            "1 / d^2 overflows"
        );
    }

    #[test]
    fn spot_is_full_inside_and_dark_outside() {
        let lamp = spot(20.0, 30.0);
        let at = |degrees| lamp.at(below(degrees)).map(|a| a.radiance.x);
        assert_eq!(at(0.0), Some(1.0));
        assert_eq!(at(19.999), Some(1.0));
        assert_eq!(at(30.001), None);
        let (near_inner, near_outer) = (at(20.01).unwrap(), at(29.99).unwrap());
        assert!(near_inner > 0.9999 && near_outer < 1e-4);
    }

    #[test]
    fn spot_weakens_without_a_jump() {
        let lamp = spot(20.0, 30.0);
        let at = |i: i32| {
            lamp.at(below(f64::from(i) / 100.0))
                .map_or(0.0, |a| a.radiance.x)
        };
        for i in 1900..3100 {
            let fall = at(i) - at(i + 1);
            assert!((0.0..0.003).contains(&fall), "at {i}: {fall}");
        }
    }

    #[test]
    fn spot_with_equal_angles_has_a_sharp_edge() {
        let lamp = spot(30.0, 30.0);
        assert_eq!(lamp.at(below(29.999)).unwrap().radiance.x, 1.0);
        assert_eq!(lamp.at(below(30.001)), None);
    }
}
