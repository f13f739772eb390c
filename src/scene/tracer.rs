//! What the language asks of a tracer, so that scripts can test where rays hit.

use super::{Camera, Node, Settings};
use std::sync::Arc;

/// What a ray found, in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TraceRecord {
    /// "hit", "miss" or "unknown".
    pub verdict: &'static str,
    /// The distance along the ray, in scene units, if it hit.
    pub t: f64,
    /// Where it hit.
    pub point: [f64; 3],
    /// The outward unit normal there.
    pub normal: [f64; 3],
    /// How many steps it took.
    pub steps: u32,
    /// How many times a field was evaluated.
    pub evaluations: u32,
}

/// What the camera's rays took: one through the middle of each pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraRecord {
    /// Steps a ray, in the mean.
    pub mean_steps: f64,
    /// The number of steps that 99 % of the rays don't exceed.
    pub p99_steps: u32,
    /// The most steps that a ray took.
    pub max_steps: u32,
    /// The pixel of that ray, the first of several: column and row from the upper left, from 0.
    pub longest: [u32; 2],
    /// Evaluations of fields a ray, in the mean.
    pub mean_evaluations: f64,
    /// How many rays ended without an answer.
    pub unknown: u64,
    /// The pixel of the first of them, row by row.
    pub first_unknown: Option<[u32; 2]>,
}

/// Traces single rays through shapes; floors above the language hand one down to it.
pub trait Tracer: Sync {
    /// What the ray from `origin` along `direction` (of any length but zero) finds first among `shown`.
    ///
    /// # Errors
    /// A sentence that says why these shapes can't be traced.
    fn trace(
        &self,
        shown: &[Arc<Node>],
        settings: &Settings,
        origin: [f64; 3],
        direction: [f64; 3],
    ) -> Result<TraceRecord, String>;

    /// What the rays of `camera` took through `shown`; the same for any number of threads.
    ///
    /// # Errors
    /// A sentence that says why these shapes can't be traced, or that this tracer has no camera.
    fn count(
        &self,
        _shown: &[Arc<Node>],
        _camera: &Camera,
        _settings: &Settings,
    ) -> Result<CameraRecord, String> {
        Err("the rays of the camera are not counted here".into())
    }
}
