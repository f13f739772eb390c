//! Places along a line, with the derivative that comes with moving on it.

use crate::num::{Dual, Interval, Vec3};
use glam::DVec3;

/// A place, moving by `way` with each unit.
pub fn moving(place: DVec3, way: DVec3) -> Vec3<Dual<f64, 1>> {
    let axis = |x: f64, rate: f64| Dual::new(x, [rate]);
    Vec3::new(
        axis(place.x, way.x),
        axis(place.y, way.y),
        axis(place.z, way.z),
    )
}

/// All places of the line through `origin`, moving by `way` with each unit, between the distances `from` and `to`.
pub fn stretched(origin: DVec3, way: DVec3, [from, to]: [f64; 2]) -> Vec3<Dual<Interval, 1>> {
    let t = Interval::new(from, to);
    let axis = |x: f64, rate: f64| {
        let rate = Interval::point(rate);
        Dual::new(Interval::point(x) + rate * t, [rate])
    };
    Vec3::new(
        axis(origin.x, way.x),
        axis(origin.y, way.y),
        axis(origin.z, way.z),
    )
}
