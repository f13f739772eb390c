//! What shading asks of the world.

use crate::catalogue::Bounds;
use crate::scene::Material;
use crate::trace::{Beam, Occlusions, Outcomes, Paint, RayColumns, Rays, Visibility, World};
use glam::DVec3;
use std::sync::Arc;

/// Surfaces that rays can find. The [`World`] is one; tests shade closed forms instead, so that the laws of light are
/// checked apart from those of marching.
pub trait Surfaces: Sync {
    /// Finds the first surface on each ray; what was in `found` before is forgotten.
    fn nearest(&self, rays: &Rays, visibility: Visibility, found: &mut Outcomes);

    /// Finds whether any opaque surface lies on the rays with these numbers, each larger than the one before; what casts a tinted
    /// shadow or none is passed over. Nothing lies on the others. What was in `found` before is forgotten.
    fn occluded(&self, rays: &RayColumns, numbers: &[u32], found: &mut Occlusions);

    /// Whether one of the rays of a beam, however far it is followed, may meet anything: it may always be said that it may.
    fn may_meet(&self, _beam: &Beam) -> bool {
        true
    }

    /// A box around the only solid there is, if it is convex and no light that falls on it from outside is ever found to be
    /// blocked by it.
    fn lone_convex(&self) -> Option<Bounds> {
        None
    }

    /// The materials at a point of the surface of `part`, with their shares.
    fn paints(&self, part: u32, point: DVec3) -> Vec<Paint<'_>>;

    /// Gives `each` the materials at these points of the surface of `part`, with the number of the point: as
    /// [`Surfaces::paints`], in order.
    fn paints_at(&self, part: u32, points: &[[f64; 3]], each: &mut dyn FnMut(usize, &[Paint<'_>])) {
        for (i, point) in points.iter().enumerate() {
            each(i, &self.paints(part, DVec3::from_array(*point)));
        }
    }

    /// Every material that some part shows.
    fn materials(&self) -> &[Arc<Material>];

    /// The number in [`Surfaces::materials`] of the material of `part`, if that is its only one and is the same at all of
    /// its points, or was painted on in the coordinates of the scene.
    fn sole(&self, _part: u32) -> Option<usize> {
        None
    }
}

impl Surfaces for World {
    fn nearest(&self, rays: &Rays, visibility: Visibility, found: &mut Outcomes) {
        self.trace_into(rays, visibility, found);
    }

    fn occluded(&self, rays: &RayColumns, numbers: &[u32], found: &mut Occlusions) {
        self.occlusions_into(rays, numbers, found);
    }

    fn may_meet(&self, beam: &Beam) -> bool {
        Self::may_meet(self, beam)
    }

    fn lone_convex(&self) -> Option<Bounds> {
        Self::lone_convex(self)
    }

    fn paints(&self, part: u32, point: DVec3) -> Vec<Paint<'_>> {
        Self::paints(self, part, point)
    }

    fn paints_at(&self, part: u32, points: &[[f64; 3]], each: &mut dyn FnMut(usize, &[Paint<'_>])) {
        Self::paints_at(self, part, points, each);
    }

    fn materials(&self) -> &[Arc<Material>] {
        Self::materials(self)
    }

    fn sole(&self, part: u32) -> Option<usize> {
        Self::sole(self, part)
    }
}
