//! What shading asks of the world.

use crate::scene::Material;
use crate::trace::{Occlusion, Outcomes, Paint, Rays, Visibility, World};
use glam::DVec3;
use std::sync::Arc;

/// Surfaces that rays can find. The [`World`] is one; tests shade closed forms instead, so that the laws of light are
/// checked apart from those of marching.
pub trait Surfaces: Sync {
    /// The first surface on each ray.
    fn nearest(&self, rays: &Rays, visibility: Visibility) -> Outcomes;

    /// Whether any opaque surface lies on each ray; what casts a tinted shadow or none is passed over.
    fn occluded(&self, rays: &Rays) -> Vec<Occlusion>;

    /// The materials at a point of the surface of `part`, with their shares.
    fn paints(&self, part: u32, point: DVec3) -> Vec<Paint<'_>>;

    /// Every material that some part shows.
    fn materials(&self) -> &[Arc<Material>];

    /// The number in [`Surfaces::materials`] of the material of `part`, if that is its only one and is the same at all of
    /// its points, or was painted on in the coordinates of the scene.
    fn sole(&self, _part: u32) -> Option<usize> {
        None
    }
}

impl Surfaces for World {
    fn nearest(&self, rays: &Rays, visibility: Visibility) -> Outcomes {
        self.trace(rays, visibility)
    }

    fn occluded(&self, rays: &Rays) -> Vec<Occlusion> {
        self.occlusions(rays)
    }

    fn paints(&self, part: u32, point: DVec3) -> Vec<Paint<'_>> {
        Self::paints(self, part, point)
    }

    fn materials(&self) -> &[Arc<Material>] {
        Self::materials(self)
    }

    fn sole(&self, part: u32) -> Option<usize> {
        Self::sole(self, part)
    }
}
