//! Floor 6: camera to film: rays, tiles, threads, statistics.

mod area;
mod block;
mod camera_tracer;
mod channel;
mod effort;
mod errors;
mod exposure;
mod film;
mod hits;
mod job;
mod refine;
mod rounds;
mod sampling;
mod spread;
mod statistics;
mod sweep;
mod tile;
mod truth_bytes;
mod view;

pub use area::Area;
pub use camera_tracer::CameraTracer;
pub use channel::Channel;
pub use effort::{Cause, Share, effort};
pub use errors::{Errors, root_mean_square};
pub use film::{Film, Plane};
pub use hits::Hits;
pub use job::{Progress, RenderOptions, Rendered, render};
pub use rounds::{Case, Run, rounds};
pub use spread::Spread;
pub use statistics::{Milliseconds, Rays, Statistics, Steps, Verdicts};
pub use sweep::{Judged, Place, Setting, Truth, pareto, sweep};
pub use view::View;
