//! Floor 7: film to bytes.

pub mod chart;
mod colormap;
mod file;
mod picture;
mod png;
mod save;
mod srgb;
mod text;

pub use colormap::{heat, hue};
pub use file::{remove_temporaries, write};
pub use picture::{Picture, picture};
pub use png::{Metadata, encode};
pub use save::{SaveError, Saved, path_of, save};
pub use srgb::{decode, encode as encode_srgb};
pub use text::{markdown, short};
