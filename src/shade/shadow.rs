//! How much of a light's radiance reaches a point.
//!
//! Shadow rays are a batch of their own. Opaque surfaces stop them at the first hit, whichever it is. Where the scene has
//! tinted shadows, they walk along the straight ray from one boundary to the next instead, and keep at each of them the
//! share that its material passes, and between them what the medium does not absorb.

use super::attenuation::absorbed;
use super::medium::{Media, Medium};
use super::palette::Palette;
use super::{Census, Features, Surfaces, offset};
use crate::trace::{Outcome, Ray, Rays, Verdict, Visibility};
use glam::DVec3;

/// How many boundaries a shadow ray may cross before it is given up as unknown, and taken as blocked.
const MAX_CROSSINGS: usize = 256;

/// Rays from surfaces towards lights; each ends before its light.
#[derive(Clone, Debug, Default)]
pub struct ShadowRays {
    /// The rays.
    pub rays: Rays,
    /// The media around their starts, one for each where shadows are tinted, else none.
    pub media: Vec<Media>,
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

/// What reaches the start of each of `shadows`. Where the tracer could not tell whether something is in the way, nothing
/// is.
pub fn passages<S: Surfaces + ?Sized>(
    (surfaces, palette): (&S, &Palette),
    features: &Features,
    shadows: &ShadowRays,
    census: &mut Census,
) -> Vec<Passage> {
    let mut passages = vec![Passage::CLEAR; shadows.rays.len()];
    if features.tinted_shadows {
        walk((surfaces, palette), shadows, &mut passages, census);
    } else if features.opaque_shadows {
        stop(surfaces, shadows, &mut passages, census);
    }
    passages
}

/// Blocks the rays that meet an opaque surface.
fn stop<S: Surfaces + ?Sized>(
    surfaces: &S,
    shadows: &ShadowRays,
    passages: &mut [Passage],
    census: &mut Census,
) {
    census.shadow += shadows.rays.len() as u64;
    let occlusions = census.timed(|t| &mut t.shadow, || surfaces.occluded(&shadows.rays));
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

/// Shadow rays on their way.
#[derive(Default)]
struct Walkers {
    rays: Rays,
    media: Vec<Media>,
    /// Which shadow ray each of them is.
    indices: Vec<usize>,
}

/// Follows the rays through tinted surfaces, all of them one boundary at a time.
fn walk<S: Surfaces + ?Sized>(
    seen: (&S, &Palette),
    shadows: &ShadowRays,
    passages: &mut [Passage],
    census: &mut Census,
) {
    let mut walkers = Walkers {
        rays: shadows.rays.clone(),
        media: shadows.media.clone(),
        indices: (0..shadows.rays.len()).collect(),
    };
    for _ in 0..MAX_CROSSINGS {
        if walkers.rays.is_empty() {
            return;
        }
        walkers = step(seen, &walkers, passages, census);
    }
    for index in walkers.indices {
        census.unknown_secondary += 1;
        passages[index] = Passage {
            share: DVec3::ZERO,
            unknown: true,
        };
    }
}

/// Takes every walker to its next boundary; those that arrive at the light or are blocked fall out.
fn step<S: Surfaces + ?Sized>(
    (surfaces, palette): (&S, &Palette),
    walkers: &Walkers,
    passages: &mut [Passage],
    census: &mut Census,
) -> Walkers {
    census.shadow += walkers.rays.len() as u64;
    let outcomes = census.timed(
        |t| &mut t.shadow,
        || surfaces.nearest(&walkers.rays, Visibility::Casting),
    );
    let looks = palette.looks(surfaces, &outcomes);
    let mut further = Walkers::default();
    for (i, hit) in outcomes.iter().enumerate() {
        let (ray, media, index) = (&walkers.rays.at(i), &walkers.media[i], walkers.indices[i]);
        census.evaluations += u64::from(hit.evaluations);
        let passage = &mut passages[index];
        let is_hit = hit.verdict == Verdict::Hit;
        let distance = if is_hit { hit.t } else { ray.t_max };
        passage.share *= absorbed(media.absorb(), distance);
        if hit.verdict == Verdict::Unknown {
            passage.unknown = true;
            census.unknown_secondary += 1;
        }
        if !is_hit {
            continue;
        }
        let Some(surface) = looks.at(i) else {
            continue;
        };
        passage.share *= surface.passes;
        if passage.share == DVec3::ZERO {
            continue;
        }
        let next = straight_on(ray, &hit);
        if next.t_max > 0.0 {
            let medium = Medium::new(hit.part, surface);
            let is_entering = hit.normal.dot(ray.direction) <= 0.0;
            further.rays.push(&next);
            further.media.push(media.across(medium, is_entering).beyond);
            further.indices.push(index);
        }
    }
    further
}

/// The rest of a ray behind what it hit.
fn straight_on(ray: &Ray, hit: &Outcome) -> Ray {
    let is_entering = hit.normal.dot(ray.direction) <= 0.0;
    let far_side = if is_entering { -hit.normal } else { hit.normal };
    let next = offset::leaving(hit, far_side, ray.direction, ray.footprint);
    let advance = (next.origin - ray.origin).dot(ray.direction);
    Ray {
        t_max: ray.t_max - advance,
        ..next
    }
}
