//! Floor 2: the scene: a typed tree of shapes with its certificates, materials, lights, camera.

mod blame;
mod camera;
mod derive;
mod description;
mod environment;
mod extent;
mod fault;
mod graph;
mod light;
mod material;
mod node;
mod period;
mod program;
mod registers;
mod settings;
mod supremum;
mod symbol;
mod tracer;

use std::sync::Arc;

pub use blame::Blame;
pub use camera::{Camera, Projection};
pub use derive::{Claim, Refutation, Trouble, gradient_bound, range_of_graph, refute, trouble};
pub use environment::{Fog, Sky};
pub use fault::Fault;
pub use graph::{Graph, GraphBuilder, Id, Mark, Obstacle, Parts};
pub use light::{Falloff, Light, Source};
pub use material::{Material, Model, Shadow, Term};
pub use node::{Displacement, FieldShape, Node, Place, Shape};
pub use program::Program;
pub use settings::{Method, Sampling, Settings};
pub use supremum::sampled_supremum;
pub use tracer::{CameraRecord, TraceRecord, Tracer};

/// Everything that a picture shows.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// The shapes that are shown, in the order of the script; each is seen where it is, also inside of another.
    pub shown: Vec<Arc<Node>>,
    /// The lights.
    pub lights: Vec<Light>,
    /// The point of view.
    pub camera: Camera,
    /// What is seen where there is no shape.
    pub sky: Sky,
    /// What lies between, if anything.
    pub fog: Option<Fog>,
    /// How the picture is made.
    pub settings: Settings,
}
