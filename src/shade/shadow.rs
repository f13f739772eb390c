//! How much of a light's radiance reaches a point.
//!
//! Shadow rays are a batch of their own. Opaque surfaces stop them at the first hit, whichever it is. Where the scene has
//! tinted shadows, what is left walks on along the straight ray from one boundary to the next, and keeps at each of
//! them the share that its material passes, and between them what the medium does not absorb.

use super::attenuation::absorbed;
use super::medium::{Media, Medium};
use super::{Census, Features, Surface, Surfaces, offset};
use crate::trace::{Ray, Verdict, Visibility};
use glam::DVec3;

/// How many boundaries a shadow ray may cross before it is given up as unknown, and taken as blocked.
const MAX_CROSSINGS: usize = 256;

/// A ray towards a light, which ends before it.
#[derive(Clone, Debug)]
pub struct ShadowRay {
    /// From the surface to the light.
    pub ray: Ray,
    /// The media around its start; empty unless shadows are tinted.
    pub media: Media,
}

/// What reaches the start of a shadow ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// The share of the light, in each channel.
    pub share: DVec3,
    /// Whether the tracer could not tell.
    pub unknown: bool,
}

impl Passage {
    const CLEAR: Self = Self {
        share: DVec3::ONE,
        unknown: false,
    };
}

/// What reaches the start of each of `rays`. Where the tracer could not tell whether something is in the way, nothing is.
pub fn passages<S: Surfaces + ?Sized>(
    surfaces: &S,
    features: &Features,
    rays: &[ShadowRay],
    census: &mut Census,
) -> Vec<Passage> {
    let mut passages = vec![Passage::CLEAR; rays.len()];
    if features.opaque_shadows {
        stop_at_opaque(surfaces, rays, &mut passages, census);
    }
    if features.tinted_shadows {
        walk_through_tinted(surfaces, rays, &mut passages, census);
    }
    passages
}

/// Blocks the rays that meet an opaque surface.
fn stop_at_opaque<S: Surfaces + ?Sized>(
    surfaces: &S,
    rays: &[ShadowRay],
    passages: &mut [Passage],
    census: &mut Census,
) {
    let batch: Vec<Ray> = rays.iter().map(|shadow| shadow.ray).collect();
    census.shadow += batch.len() as u64;
    let occlusions = census.timed(|| surfaces.occluded(&batch));
    for (passage, occlusion) in passages.iter_mut().zip(occlusions) {
        census.evaluations += u64::from(occlusion.evaluations);
        match occlusion.verdict {
            Verdict::Hit => passage.share = DVec3::ZERO,
            Verdict::Miss => {}
            Verdict::Unknown => {
                passage.unknown = true;
                census.unknown_secondary += 1;
            }
        }
    }
}

/// A shadow ray on its way.
struct Walker {
    index: usize,
    ray: Ray,
    media: Media,
}

/// Follows the rays that are not blocked through tinted surfaces, all of them one boundary at a time.
fn walk_through_tinted<S: Surfaces + ?Sized>(
    surfaces: &S,
    rays: &[ShadowRay],
    passages: &mut [Passage],
    census: &mut Census,
) {
    let free = |index: &usize| passages[*index].share != DVec3::ZERO;
    let mut walkers: Vec<Walker> = (0..rays.len())
        .filter(free)
        .map(|index| Walker {
            index,
            ray: rays[index].ray,
            media: rays[index].media.clone(),
        })
        .collect();
    for _ in 0..MAX_CROSSINGS {
        if walkers.is_empty() {
            return;
        }
        walkers = step(surfaces, walkers, passages, census);
    }
    for walker in walkers {
        census.unknown_secondary += 1;
        passages[walker.index] = Passage {
            share: DVec3::ZERO,
            unknown: true,
        };
    }
}

/// Takes every walker to its next boundary; those that arrive at the light or are blocked fall out.
fn step<S: Surfaces + ?Sized>(
    surfaces: &S,
    walkers: Vec<Walker>,
    passages: &mut [Passage],
    census: &mut Census,
) -> Vec<Walker> {
    let batch: Vec<Ray> = walkers.iter().map(|walker| walker.ray).collect();
    census.shadow += batch.len() as u64;
    let outcomes = census.timed(|| surfaces.nearest(&batch, Visibility::Casting));
    let mut on_their_way = Vec::new();
    for (mut walker, hit) in walkers.into_iter().zip(outcomes) {
        census.evaluations += u64::from(hit.evaluations);
        let passage = &mut passages[walker.index];
        let is_hit = hit.verdict == Verdict::Hit;
        let distance = if is_hit { hit.t } else { walker.ray.t_max };
        passage.share *= absorbed(walker.media.absorb(), distance);
        if hit.verdict == Verdict::Unknown {
            passage.unknown = true;
            census.unknown_secondary += 1;
        }
        if !is_hit {
            continue;
        }
        let Some(surface) = Surface::mixed(&surfaces.paints(hit.part, hit.point)) else {
            continue;
        };
        passage.share *= surface.passes;
        if passage.share == DVec3::ZERO {
            continue;
        }
        // The ray goes on, straight, on the far side; what it is displaced by is no longer before it.
        let direction = walker.ray.direction;
        let is_entering = hit.normal.dot(direction) <= 0.0;
        let far_side = if is_entering { -hit.normal } else { hit.normal };
        let medium = Medium::new(hit.part, &surface);
        walker.media = walker.media.across(medium, is_entering).beyond;
        let next = offset::leaving(&hit, far_side, direction, walker.ray.footprint);
        let advance = (next.origin - walker.ray.origin).dot(direction);
        walker.ray = Ray {
            t_max: walker.ray.t_max - advance,
            ..next
        };
        if walker.ray.t_max > 0.0 {
            on_their_way.push(walker);
        }
    }
    on_their_way
}
