//! Floor 4: rays to hits, by the batch.
//!
//! A [`World`] is a list of parts. Spheres, ellipsoids, planes, boxes, bars, tori, triangles and quadrilaterals of hard unions, and hard combinations of
//! convex ones of them, are met in closed form; what is left is marched, each part inside its bounds. The default method takes bundles of rays (`sweep`) through stages of thinned
//! combinations (`stages`) in packets of lanes (`stride`, `newton`); the others are small machines, one for each ray
//! (`method`). What a ray finds depends neither on the rays it is traced with nor on the number of threads.

mod along;
pub mod analytic;
mod apart;
mod beam;
mod bits;
mod bundle;
mod chord;
mod cones;
mod cut;
mod descent;
mod evidence;
mod fan;
mod finding;
mod hierarchy;
mod inclines;
mod join;
mod march;
mod method;
mod newton;
mod outcome;
mod packet;
mod part;
mod precision;
mod probe;
mod quartic;
mod ray;
mod rays;
mod refuted;
mod ring;
mod scene_tracer;
mod scout;
mod single;
mod stages;
mod stride;
mod survey;
mod sweep;
mod unpruned;
pub mod vector;
mod world;

pub use beam::Beam;
pub use evidence::Witness;
pub use outcome::{Occlusion, Outcome, Verdict, count};
pub use part::PartKind;
pub use precision::{Precision, sphere_traced};
pub use ray::{Footprint, Ray};
pub use rays::{Occlusions, Outcomes, RayColumns, Rays};
pub use refuted::Refuted;
pub use scene_tracer::SceneTracer;
pub use unpruned::union;
pub use world::{Paint, Visibility, World};
