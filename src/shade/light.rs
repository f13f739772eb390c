//! Light as it arrives at a point.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::highlight::{GROUP, Group};
use crate::scene::{Falloff, Light, Source};
use glam::DVec3;

/// A light, ready to shine on many points.
#[derive(Clone, Copy, Debug)]
pub struct Lamp {
    light: Light,
    /// The cosines of the outer and inner angle of a spot.
    edge: [f64; 2],
}

/// The light that arrives at some points, if nothing is in the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrivals {
    /// The unit vectors towards the light, by axis.
    pub toward: [Group; 3],
    /// The shares of the lamp's radiance, which may be more than 1: 0 where it is black, and at the very place of the light,
    /// where it has no direction.
    pub strength: Group,
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

    /// Its colour and strength, linear RGB, where it arrives in full.
    pub fn radiance(&self) -> DVec3 {
        self.light.radiance
    }

    /// Where it stands; `None` where it is infinitely far.
    pub fn position(&self) -> Option<DVec3> {
        match self.light.source {
            Source::Directional { .. } => None,
            Source::Point { position, .. } | Source::Spot { position, .. } => Some(position),
        }
    }

    /// What arrives at some points, by axis. To be called with the instructions of lanes.
    #[inline(always)]
    pub fn shine(&self, points: [&Group; 3]) -> Arrivals {
        // A loop for each kind: within it, all points are alike.
        match self.light.source {
            Source::Directional { toward } => Arrivals {
                toward: toward.to_array().map(|part| [part; GROUP]),
                strength: [1.0; GROUP],
            },
            Source::Point { position, falloff } => arrivals(position, falloff, points),
            Source::Spot {
                position,
                axis,
                falloff,
                ..
            } => {
                let mut all = arrivals(position, falloff, points);
                for i in 0..GROUP {
                    let [x, y, z] = [0, 1, 2].map(|axis: usize| all.toward[axis][i]);
                    all.strength[i] *= self.share(-DVec3::new(x, y, z).dot(axis));
                }
                all
            }
        }
    }

    /// The share of a spot's light at an angle from its axis with this `cosine`: 1 inside the inner angle, 0 outside of
    /// the outer, with continuous slope between (smoothstep of the cosine).
    #[inline(always)]
    fn share(&self, cosine: f64) -> f64 {
        let [outer, inner] = self.edge;
        let x = (cosine - outer) / (inner - outer);
        let between = x * x * (3.0 - 2.0 * x);
        let beyond = if cosine <= outer { 0.0 } else { between };
        if cosine >= inner { 1.0 } else { beyond }
    }
}

/// What arrives at points from `position`.
#[inline(always)]
fn arrivals(position: DVec3, falloff: Falloff, points: [&Group; 3]) -> Arrivals {
    let mut all = Arrivals {
        toward: [[0.0; GROUP]; 3],
        strength: [1.0; GROUP],
    };
    for i in 0..GROUP {
        let way = position - DVec3::new(points[0][i], points[1][i], points[2][i]);
        let distance = way.length();
        let inverse = 1.0 / distance;
        for axis in 0..3 {
            all.toward[axis][i] = way[axis] * inverse;
        }
        let strength = match falloff {
            Falloff::None => 1.0,
            Falloff::InverseSquare => inverse * inverse,
        };
        let arrives = (distance > 0.0) & (strength <= f64::MAX);
        all.strength[i] = if arrives { strength } else { 0.0 };
    }
    all
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

    /// What arrives at a point; `None` where nothing does.
    fn at(lamp: &Lamp, point: DVec3) -> Option<DVec3> {
        let points = point.to_array().map(|part| [part; GROUP]);
        let arrivals = lamp.shine(points.each_ref());
        let radiance = lamp.radiance() * arrivals.strength[0];
        (radiance != DVec3::ZERO).then_some(radiance)
    }

    /// The point two units below the spot whose direction is this far from its axis.
    fn below(degrees: f64) -> DVec3 {
        DVec3::new(2.0 * degrees.to_radians().tan(), 0.0, 0.0)
    }

    #[test]
    fn inverse_square_quarters_at_twice_the_distance() {
        let lamp = point(Falloff::InverseSquare);
        let at = |y: f64| at(&lamp, DVec3::new(0.0, y, 0.0)).unwrap();
        assert_eq!(at(1.0), DVec3::new(4.0, 2.0, 1.0));
        assert_eq!(at(0.0), at(1.0) / 4.0);
        assert_eq!(at(-2.0), at(1.0) / 16.0);
    }

    #[test]
    fn without_falloff_distance_does_not_matter() {
        let lamp = point(Falloff::None);
        let at = |y: f64| at(&lamp, DVec3::new(0.0, y, 0.0)).unwrap();
        assert_eq!(at(1.0), at(-1e6));
    }

    #[test]
    fn at_its_own_place_a_light_gives_nothing() {
        for falloff in [Falloff::None, Falloff::InverseSquare] {
            assert_eq!(at(&point(falloff), DVec3::new(0.0, 2.0, 0.0)), None);
        }
        let near = DVec3::new(1e-200, 2.0, 0.0);
        assert_eq!(
            at(&point(Falloff::InverseSquare), near),
            None,
            "1 / d^2 overflows"
        );
    }

    #[test]
    fn spot_is_full_inside_and_dark_outside() {
        let lamp = spot(20.0, 30.0);
        let at = |degrees| at(&lamp, below(degrees)).map(|radiance| radiance.x);
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
            let radiance = at(&lamp, below(f64::from(i) / 100.0));
            radiance.map_or(0.0, |radiance| radiance.x)
        };
        for i in 1900..3100 {
            let fall = at(i) - at(i + 1);
            assert!((0.0..0.003).contains(&fall), "at {i}: {fall}");
        }
    }

    #[test]
    fn spot_with_equal_angles_has_a_sharp_edge() {
        let lamp = spot(30.0, 30.0);
        assert_eq!(at(&lamp, below(29.999)).unwrap().x, 1.0);
        assert_eq!(at(&lamp, below(30.001)), None);
    }
}
