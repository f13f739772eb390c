//! The blends: seams of set operations, and operations of their own.

mod chamfer;
mod circular;
mod cubic;
mod engrave;
mod exponential;
mod fillet;
mod groove;
mod hard;
mod morph;
mod pipe;
mod smooth;
mod stairs;
mod tongue;
mod xor;

pub use chamfer::Chamfer;
pub use circular::Circular;
pub use cubic::Cubic;
pub use engrave::Engrave;
pub use exponential::Exponential;
pub use fillet::Fillet;
pub use groove::Groove;
pub use hard::Hard;
pub use morph::Morph;
pub use pipe::Pipe;
pub use smooth::Smooth;
pub use stairs::Stairs;
pub use tongue::Tongue;
pub use xor::Xor;
