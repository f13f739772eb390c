//! Whitted's recursion as a loop over waves.
//!
//! ```text
//! camera rays -> trace -> shade -> reflected and refracted rays -> trace -> shade -> ... until the depth limit
//!                           |
//!                           +--> shadow rays, a batch of their own
//! ```
//!
//! A wave is all rays of one depth; each knows the pixel sample that it adds to and by which weight. Rays of a sample
//! keep their order, so the sum of a sample has the same bits however the samples are batched. Source: Whitted 1980.

use super::attenuation::{absorbed, sight, through_fog};
use super::light::Lamp;
use super::meeting::{Meeting, Onward};
use super::shadow::{ShadowRays, passages};
use super::wave::{Path, Wave, Waves};
use super::{Census, Features, Surface, Surfaces, offset, phong, sky};
use crate::scene::{Fog, Material, Scene, Sky};
use crate::trace::{Outcome, Ray, Verdict, Visibility};
use glam::DVec3;
use std::sync::Arc;

/// Rays whose weight is below this in all channels are left out: half a step of an 8-bit picture.
pub const FAINTEST: f64 = 1.0 / 512.0;

/// The pipeline from rays to light.
pub struct Whitted<'a, S: Surfaces + ?Sized> {
    surfaces: &'a S,
    features: Features,
    lamps: Vec<Lamp>,
    sky: Sky,
    fog: Option<Fog>,
    depth: u32,
    /// The surfaces of the materials that are the same at all points, by their numbers.
    plain: Vec<Option<Surface>>,
}

/// What the eye receives along its rays.
#[derive(Clone, Debug, PartialEq)]
pub struct Received {
    /// The radiance along each ray, linear RGB.
    pub radiance: Vec<DVec3>,
    /// Whether the tracer could not tell what this ray, or one that it led to, hits.
    pub unknown: Vec<bool>,
}

/// What is gained if shadow rays pass.
#[derive(Default)]
struct Gains {
    rays: ShadowRays,
    samples: Vec<usize>,
    radiance: Vec<DVec3>,
}

impl<'a, S: Surfaces + ?Sized> Whitted<'a, S> {
    /// The pipeline for the light and the settings of `scene` on these `surfaces`.
    pub fn new(scene: &Scene, surfaces: &'a S) -> Self {
        let features = Features::new(scene, surfaces.materials());
        Self {
            surfaces,
            features,
            lamps: scene.lights.iter().copied().map(Lamp::new).collect(),
            sky: scene.sky,
            fog: scene.fog.filter(|_| features.fog),
            depth: scene.settings.depth,
            plain: surfaces.materials().iter().map(plain_surface).collect(),
        }
    }

    /// The stages that the scene compiled in.
    pub fn features(&self) -> Features {
        self.features
    }

    /// The first surface on each ray, as far as one sees through the fog.
    fn nearest(&self, rays: &[Ray]) -> Vec<Outcome> {
        let Some(fog) = &self.fog else {
            return self.surfaces.nearest(rays, Visibility::All);
        };
        let seen = |ray: &Ray| Ray {
            t_max: ray.t_max.min(sight(fog)),
            ..*ray
        };
        let rays: Vec<Ray> = rays.iter().map(seen).collect();
        self.surfaces.nearest(&rays, Visibility::All)
    }

    /// What the camera rays hit.
    pub fn first_hits(&self, rays: &[Ray], census: &mut Census) -> Vec<Outcome> {
        let outcomes = census.timed(|t| &mut t.primary, || self.nearest(rays));
        census.primary += rays.len() as u64;
        for outcome in &outcomes {
            census.evaluations += u64::from(outcome.evaluations);
            match outcome.verdict {
                Verdict::Hit => census.hits += 1,
                Verdict::Miss => census.misses += 1,
                Verdict::Unknown => census.unknown += 1,
            }
        }
        outcomes
    }

    /// The colours of the materials that the camera rays hit, without any light, and of the sky.
    pub fn flat_colors(&self, rays: &[Ray], outcomes: &[Outcome]) -> Vec<DVec3> {
        let color = |(ray, outcome): (&Ray, &Outcome)| match self.surface(outcome) {
            Some(surface) => surface.color,
            None => sky::radiance(&self.sky, ray.direction),
        };
        rays.iter().zip(outcomes).map(color).collect()
    }

    /// The light along camera rays that hit `outcomes`.
    pub fn light(&self, rays: &[Ray], outcomes: &[Outcome], census: &mut Census) -> Received {
        let mut light = Received {
            radiance: vec![DVec3::ZERO; rays.len()],
            unknown: vec![false; rays.len()],
        };
        // Rays that met nothing see the sky, unless fog lies before it.
        let is_sky = |outcome: &Outcome| outcome.verdict == Verdict::Miss && self.fog.is_none();
        let mut samples = Vec::with_capacity(rays.len());
        let mut met = Vec::with_capacity(rays.len());
        for (sample, outcome) in outcomes.iter().enumerate() {
            if is_sky(outcome) {
                light.radiance[sample] = sky::radiance(&self.sky, rays[sample].direction);
            } else {
                samples.push(sample);
                met.push(*outcome);
            }
        }
        let wave = Wave::from_camera(rays, &samples);
        let mut waiting = self.shade(wave, &met, &mut light, census);
        while let Some(wave) = waiting.pop() {
            let outcomes = census.timed(|t| &mut t.secondary, || self.nearest(&wave.rays));
            for outcome in &outcomes {
                census.evaluations += u64::from(outcome.evaluations);
                census.unknown_secondary += u64::from(outcome.verdict == Verdict::Unknown);
            }
            waiting.extend(self.shade(wave, &outcomes, &mut light, census));
        }
        light
    }

    /// Adds what a wave receives to `light`, and gives the waves that follow from it.
    fn shade(
        &self,
        wave: Wave,
        outcomes: &[Outcome],
        light: &mut Received,
        census: &mut Census,
    ) -> Vec<Wave> {
        let mut next = Waves::new(wave.depth + 1);
        let mut gains = Gains::default();
        let rays = wave.rays.iter().zip(wave.paths);
        for ((ray, mut path), outcome) in rays.zip(outcomes) {
            let sample = path.sample;
            light.unknown[sample] |= outcome.verdict == Verdict::Unknown;
            let surface = self.surface(outcome);
            let distance = surface.map_or(f64::INFINITY, |_| outcome.t);
            light.radiance[sample] += self.travel(&mut path, distance);
            let Some(surface) = &surface else {
                light.radiance[sample] += self.background(ray, &path);
                continue;
            };
            let hit = Meeting::new(ray, &path, outcome, surface);
            light.radiance[sample] += path.weight * phong::ambient(surface);
            if self.features.lit && surface.is_lit() {
                self.ask_lamps(&hit, &mut gains);
            }
            if self.features.reflects {
                self.send_on(&hit, &mut next, census);
            }
        }
        let passed = passages(self.surfaces, &self.features, &gains.rays, census);
        for (i, passage) in passed.iter().enumerate() {
            light.radiance[gains.samples[i]] += gains.radiance[i] * passage.share;
            light.unknown[gains.samples[i]] |= passage.unknown;
        }
        next.waves
    }

    /// What was hit; `None` where nothing was.
    fn surface(&self, outcome: &Outcome) -> Option<Surface> {
        if outcome.verdict != Verdict::Hit {
            return None;
        }
        let number = self.surfaces.sole(outcome.part);
        let plain = number.and_then(|number| self.plain[number]);
        plain.or_else(|| Surface::of(self.surfaces, outcome.part, outcome.point))
    }

    /// Weakens a path over `distance`, and gives the light that fog adds to it on the way.
    fn travel(&self, path: &mut Path, distance: f64) -> DVec3 {
        if self.features.absorbs {
            path.weight *= absorbed(path.media.absorb(), distance);
        }
        let Some(fog) = &self.fog else {
            return DVec3::ZERO;
        };
        let (passed, added) = through_fog(fog, distance);
        let scattered = path.weight * added;
        path.weight *= passed;
        scattered
    }

    /// The sky behind a ray, unless nothing of it is left on the infinite way.
    fn background(&self, ray: &Ray, path: &Path) -> DVec3 {
        if path.weight == DVec3::ZERO {
            return DVec3::ZERO;
        }
        path.weight * sky::radiance(&self.sky, ray.direction)
    }

    /// Collects what each lamp adds at a hit if nothing is in the way, with the ray that finds out.
    fn ask_lamps(&self, hit: &Meeting, gains: &mut Gains) {
        let view = -hit.ray.direction;
        for lamp in &self.lamps {
            let Some(arrival) = lamp.at(hit.outcome.point) else {
                continue;
            };
            let seen = phong::reflectance(hit.surface, hit.normal, arrival.toward, view);
            if seen == DVec3::ZERO {
                continue;
            }
            let mut ray = hit.leaving(hit.normal, arrival.toward);
            if let Some(position) = arrival.position {
                let way = position - ray.origin;
                let distance = way.length();
                ray.direction = way / distance;
                ray.t_max = offset::before(distance);
            }
            gains.rays.rays.push(ray);
            if self.features.tinted_shadows {
                gains.rays.media.push(hit.path.media.clone());
            }
            gains.samples.push(hit.path.sample);
            gains
                .radiance
                .push(hit.path.weight * seen * arrival.radiance);
        }
    }

    /// Adds the reflected and the refracted ray of a hit to the next waves, unless they are too deep or too faint.
    fn send_on(&self, hit: &Meeting, next: &mut Waves, census: &mut Census) {
        let Onward {
            reflected,
            refracted,
        } = hit.onward();
        if let Some(weight) = self.passing(hit, reflected.share, next, census) {
            census.reflected += 1;
            let ray = hit.leaving(hit.normal, reflected.direction);
            next.push(
                ray,
                Path {
                    weight,
                    ..hit.path.clone()
                },
            );
        }
        let Some((branch, crossing)) = refracted else {
            return;
        };
        if let Some(weight) = self.passing(hit, branch.share, next, census) {
            census.refracted += 1;
            let ray = hit.leaving(-hit.normal, branch.direction);
            let path = Path {
                weight,
                sample: hit.path.sample,
                media: crossing.beyond,
            };
            next.push(ray, path);
        }
    }

    /// The weight of a ray with this share of a hit's; `None` if it is zero, too faint or too deep.
    fn passing(
        &self,
        hit: &Meeting,
        share: f64,
        next: &Waves,
        census: &mut Census,
    ) -> Option<DVec3> {
        if share == 0.0 {
            return None;
        }
        let weight = hit.path.weight * share;
        if weight.max_element() < FAINTEST {
            census.too_faint += 1;
            return None;
        }
        if next.depth > self.depth {
            census.too_deep += 1;
            return None;
        }
        Some(weight)
    }
}

/// The surface of a material that is the same at all points.
fn plain_surface(material: &Arc<Material>) -> Option<Surface> {
    (!material.has_patterns()).then(|| Surface::new(material, [0.0; 3]))
}
