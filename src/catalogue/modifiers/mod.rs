//! Modifiers: transforms that keep distances, and warps that do not.

mod bend;
mod elongate;
mod extrude;
mod mirror;
mod mirrored_repeat;
mod offset;
mod polar;
mod repeat;
mod revolve;
mod rotate;
mod scale;
mod shear;
mod shell;
mod sweep;
mod taper;
mod translate;
mod twist;
mod warp;

pub use bend::Bend;
pub use elongate::Elongate;
pub use extrude::Extrude;
pub use mirror::Mirror;
pub use mirrored_repeat::MirroredRepeat;
pub use offset::Offset;
pub use polar::Polar;
pub use repeat::Repeat;
pub use revolve::Revolve;
pub use rotate::Rotate;
pub use scale::Scale;
pub use shear::Shear;
pub use shell::Shell;
pub use taper::Taper;
pub use translate::Translate;
pub use twist::Twist;
pub use warp::Warp;
