//! Primitives in the plane, for `extrude` and `revolve`.

mod circle;
mod polygon;
mod rectangle;
mod ring;
mod segment;

pub use circle::Circle;
pub use polygon::Polygon;
pub use rectangle::Rectangle;
pub use ring::Ring;
pub use segment::Segment;
