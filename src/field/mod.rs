//! Floor 3: fields as closures over any number, and which material a point shows.

mod compile;
mod governor;
mod gradient;
mod packets;
mod paint;
mod processor;
mod thicket;

pub use compile::{
    Closure, Task, Walked, combine, compile, compile_convex, compile_graph, compile_wide, modify,
    place, run_at,
};
pub use governor::governor;
pub use gradient::normal;
pub use packets::{Packet, Packets};
pub use paint::{Brush, Share, shares};
pub use processor::Level;
pub use thicket::{Reach, Thicket, Thinned};
