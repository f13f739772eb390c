//! Primitives in space.

mod capsule;
mod cone;
mod cuboid;
mod cylinder;
mod ellipsoid;
mod plane;
mod sphere;
mod torus;
mod triangle;

pub use capsule::Capsule;
pub use cone::Cone;
pub use cuboid::Cuboid;
pub use cylinder::Cylinder;
pub use ellipsoid::Ellipsoid;
pub use plane::Plane;
pub use sphere::Sphere;
pub use torus::Torus;
pub use triangle::Triangle;
