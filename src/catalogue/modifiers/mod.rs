//! Modifiers: transforms that keep distances, and warps that do not.

mod extrude;
mod mirror;
mod offset;
mod repeat;
mod revolve;
mod rotate;
mod scale;
mod shell;
mod translate;
mod twist;

pub use extrude::Extrude;
pub use mirror::Mirror;
pub use offset::Offset;
pub use repeat::Repeat;
pub use revolve::Revolve;
pub use rotate::Rotate;
pub use scale::Scale;
pub use shell::Shell;
pub use translate::Translate;
pub use twist::Twist;
