//! Primitives in space.

mod box_frame;
mod capped_cone;
mod capsule;
mod cone;
mod cuboid;
mod cylinder;
mod ellipsoid;
mod link;
mod plane;
mod slab;
mod sphere;
mod torus;
mod triangle;

pub use box_frame::BoxFrame;
pub use capped_cone::CappedCone;
pub use capsule::Capsule;
pub use cone::Cone;
pub use cuboid::Cuboid;
pub use cylinder::Cylinder;
pub use ellipsoid::Ellipsoid;
pub use link::Link;
pub use plane::Plane;
pub use slab::Slab;
pub use sphere::Sphere;
pub use torus::Torus;
pub use triangle::Triangle;
