//! What each method asks of the parts of a world, beyond their fields.

use crate::scene::Method;

/// Where rays are followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// Inside of a part's bounds.
    Bounds,
    /// From the ray's origin, as published, wherever the constant holds in all of space; else inside of the bounds.
    Constant,
    /// From the ray's origin, whatever the constant.
    Everywhere,
}

/// The demands of a method.
#[derive(Clone, Copy, Debug)]
pub struct Demands {
    /// Whether derivatives along rays are wanted of convex fields.
    pub slopes: bool,
    /// Whether rays are walked in lanes: spheres, planes, boxes and triangles are entered in closed form, combinations are
    /// thinned out.
    pub lanes: bool,
    /// Where rays are followed.
    pub reach: Reach,
}

impl Demands {
    /// The demands of `method`.
    pub fn of(method: Method) -> Self {
        let reach = match method {
            Method::Auto | Method::Certified | Method::Convex => Reach::Bounds,
            Method::Sphere | Method::Relaxed | Method::AutoRelaxed | Method::Enhanced => {
                Reach::Constant
            }
            Method::Segment | Method::Bisect | Method::Interval | Method::Probe => Reach::Bounds,
            Method::Reference => Reach::Everywhere,
        };
        Self {
            lanes: method == Method::Auto,
            slopes: matches!(method, Method::Auto | Method::Convex),
            reach,
        }
    }
}
