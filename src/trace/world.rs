//! The world: a scene that is ready to be traced.

use super::{Occlusion, Outcome, Ray};
use crate::scene::{Fault, Material, Scene};
use glam::DVec3;
use std::sync::Arc;

/// Which parts of the world a ray can see.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Visibility {
    /// All of them.
    All,
    /// Those that cast shadows, opaque or tinted.
    Casting,
}

/// A material that a surface point shows, with its share.
#[derive(Clone, Copy, Debug)]
pub struct Paint<'a> {
    /// The material.
    pub material: &'a Arc<Material>,
    /// Its share; the shares of a point sum to 1.
    pub weight: f64,
    /// The point in the coordinates of the shape that was painted, for patterns.
    pub point: [f64; 3],
}

/// A scene that is ready to be traced.
pub struct World {}

impl World {
    /// The world of everything that `scene` shows.
    ///
    /// # Errors
    /// If a shape has no finite Lipschitz constant; the fault names it and the way out.
    pub fn new(_scene: &Scene) -> Result<Self, Fault> {
        Ok(Self {})
    }

    /// The first surface on each ray.
    pub fn nearest(&self, _rays: &[Ray], _visibility: Visibility) -> Vec<Outcome> {
        Vec::new()
    }

    /// Whether any opaque surface lies on each ray; parts whose shadow is tinted or none are passed over.
    pub fn occluded(&self, _rays: &[Ray]) -> Vec<Occlusion> {
        Vec::new()
    }

    /// The materials at a point of the surface of `part`, one or more.
    pub fn paints(&self, _part: u32, _point: DVec3) -> Vec<Paint<'_>> {
        Vec::new()
    }

    /// Every material that some part shows.
    pub fn materials(&self) -> &[Arc<Material>] {
        &[]
    }

    /// How many parts there are.
    pub fn parts(&self) -> usize {
        0
    }
}
