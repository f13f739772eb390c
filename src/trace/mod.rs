//! Floor 4: rays to hits, by the batch.
//!
//! A [`World`] is a list of parts. Spheres, planes and triangles of hard unions are entered analytically; what is left
//! is marched, each part inside its bounds, in packets of lanes. Every ray is a small machine of its own
//! (`method`), so its result depends neither on the packet it rides in nor on the number of threads.

pub mod analytic;
mod beam;
mod bundle;
mod hierarchy;
mod join;
mod march;
mod method;
mod newton;
mod outcome;
mod part;
mod ray;
mod scene_tracer;
mod stride;
mod survey;
mod sweep;
mod world;

pub use outcome::{Occlusion, Outcome, Verdict};
pub use part::PartKind;
pub use ray::{Footprint, Ray};
pub use scene_tracer::SceneTracer;
pub use world::{Paint, Visibility, World};
