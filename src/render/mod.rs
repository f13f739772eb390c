//! Floor 6: camera to film: rays, tiles, threads, statistics.

mod channel;
mod film;
mod job;
mod rounds;
mod sampling;
mod spread;
mod statistics;
mod tile;
mod view;

pub use channel::Channel;
pub use film::{Film, Plane};
pub use job::{Progress, RenderOptions, Rendered, render};
pub use rounds::{Case, Run, rounds};
pub use spread::Spread;
pub use statistics::{Milliseconds, Rays, Statistics, Steps, Verdicts};
pub use view::View;
