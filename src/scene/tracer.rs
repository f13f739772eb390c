//! What the language asks of a tracer, so that scripts can test where rays hit.

use super::{Node, Settings};
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
}
