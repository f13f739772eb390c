//! Floor 3: fields as closures over any number, and which material a point shows.

mod compile;
mod governor;
mod gradient;
mod packets;
mod paint;
mod processor;

pub use compile::{Closure, compile, compile_convex, compile_wide};
pub use governor::governor;
pub use gradient::normal;
pub use packets::{Packet, Packets};
pub use paint::{Share, shares};
pub use processor::Level;
