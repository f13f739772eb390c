//! Normals are gradients, by dual numbers.

use super::Closure;
use crate::num::{Dual, Vec3};
use glam::DVec3;

/// The unit normal at `p`: the direction of the gradient. Where the gradient vanishes or is not a number (the centre of
/// a sphere, the axis of a torus, a flat spot of a user's field), the gradient a little back along the ray, at distance
/// `back`, and where that fails too, the direction against the ray.
pub fn normal(gradient: &Closure<Dual<f64, 3>>, p: DVec3, direction: DVec3, back: f64) -> DVec3 {
    unit_gradient(gradient, p)
        .or_else(|| unit_gradient(gradient, p - direction * back))
        .unwrap_or(-direction)
}

fn unit_gradient(gradient: &Closure<Dual<f64, 3>>, p: DVec3) -> Option<DVec3> {
    let value = gradient(&Vec3::new(
        Dual::variable(p.x, 0),
        Dual::variable(p.y, 1),
        Dual::variable(p.z, 2),
    ));
    DVec3::from_array(value.partial).try_normalize()
}
