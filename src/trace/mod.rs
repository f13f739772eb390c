//! Floor 4: rays to hits, by the batch.

mod outcome;
mod ray;
mod world;

pub use outcome::{Occlusion, Outcome, Verdict};
pub use ray::{Footprint, Ray};
pub use world::{Paint, Visibility, World};
