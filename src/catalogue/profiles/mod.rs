//! Primitives in the plane, for `extrude` and `revolve`.

mod circle;
mod polygon;
mod rectangle;

pub use circle::Circle;
pub use polygon::Polygon;
pub use rectangle::Rectangle;
