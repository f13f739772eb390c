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

use super::attenuation::{absorbed, through_fog};
use super::light::Lamp;
use super::meeting::Meeting;
use super::shadow::{ShadowRay, passages};
use super::wave::{Path, Wave, cut_between_samples};
use super::{Census, Features, Surface, Surfaces, offset, phong, sky};
use crate::scene::{Fog, Scene, Sky};
use crate::trace::{Outcome, Ray, Verdict, Visibility};
use glam::DVec3;

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
}

/// What the eye receives along its rays.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// The radiance along each ray, linear RGB.
    pub radiance: Vec<DVec3>,
    /// Whether the tracer could not tell what this ray, or one that it led to, hits.
    pub unknown: Vec<bool>,
}

/// A shadow ray with what is gained if it passes.
struct Gain {
    sample: usize,
    radiance: DVec3,
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
        }
    }

    /// The stages that the scene compiled in.
    pub fn features(&self) -> Features {
        self.features
    }

    /// What the camera rays hit.
    pub fn first_hits(&self, rays: &[Ray], census: &mut Census) -> Vec<Outcome> {
        let outcomes = census.timed(|| self.surfaces.nearest(rays, Visibility::All));
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
    pub fn light(&self, rays: &[Ray], outcomes: Vec<Outcome>, census: &mut Census) -> Light {
        let mut light = Light {
            radiance: vec![DVec3::ZERO; rays.len()],
            unknown: vec![false; rays.len()],
        };
        let camera = Wave {
            depth: 0,
            paths: rays.iter().enumerate().map(Path::from_camera).collect(),
        };
        let mut waiting = self.shade(camera, &outcomes, &mut light, census);
        while let Some(wave) = waiting.pop() {
            let rays: Vec<Ray> = wave.paths.iter().map(|path| path.ray).collect();
            let outcomes = census.timed(|| self.surfaces.nearest(&rays, Visibility::All));
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
        light: &mut Light,
        census: &mut Census,
    ) -> Vec<Wave> {
        let mut next = Vec::new();
        let (mut gains, mut shadows) = (Vec::new(), Vec::new());
        for (mut path, outcome) in wave.paths.into_iter().zip(outcomes) {
            let sample = path.sample;
            light.unknown[sample] |= outcome.verdict == Verdict::Unknown;
            let surface = self.surface(outcome);
            let distance = surface.map_or(f64::INFINITY, |_| outcome.t);
            light.radiance[sample] += self.travel(&mut path, distance);
            let Some(surface) = surface else {
                light.radiance[sample] += self.background(&path);
                continue;
            };
            let hit = Meeting::new(path, outcome, surface);
            light.radiance[sample] += hit.path.weight * phong::ambient(&hit.surface);
            if self.features.lit && hit.surface.is_lit() {
                self.ask_lamps(&hit, &mut gains, &mut shadows);
            }
            if self.features.reflects {
                self.send_on(&hit, wave.depth, &mut next, census);
            }
        }
        let passed = passages(self.surfaces, &self.features, &shadows, census);
        for (gain, passage) in gains.iter().zip(passed) {
            light.radiance[gain.sample] += gain.radiance * passage.share;
            light.unknown[gain.sample] |= passage.unknown;
        }
        cut_between_samples(wave.depth + 1, next)
    }

    /// What was hit; `None` where nothing was.
    fn surface(&self, outcome: &Outcome) -> Option<Surface> {
        if outcome.verdict != Verdict::Hit {
            return None;
        }
        Surface::mixed(&self.surfaces.paints(outcome.part, outcome.point))
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

    /// The sky behind a path, unless nothing of it is left on the infinite way.
    fn background(&self, path: &Path) -> DVec3 {
        if path.weight == DVec3::ZERO {
            return DVec3::ZERO;
        }
        path.weight * sky::radiance(&self.sky, path.ray.direction)
    }

    /// Collects what each lamp adds at a hit if nothing is in the way, with the ray that finds out.
    fn ask_lamps(&self, hit: &Meeting, gains: &mut Vec<Gain>, shadows: &mut Vec<ShadowRay>) {
        let view = -hit.path.ray.direction;
        for arrival in self
            .lamps
            .iter()
            .filter_map(|lamp| lamp.at(hit.outcome.point))
        {
            let seen = phong::reflectance(&hit.surface, hit.normal, arrival.toward, view);
            if seen == DVec3::ZERO {
                continue;
            }
            gains.push(Gain {
                sample: hit.path.sample,
                radiance: hit.path.weight * seen * arrival.radiance,
            });
            let mut ray = hit.leaving(hit.normal, arrival.toward);
            if let Some(position) = arrival.position {
                let way = position - ray.origin;
                let distance = way.length();
                ray.direction = way / distance;
                ray.t_max = offset::before(distance);
            }
            shadows.push(ShadowRay {
                ray,
                media: hit.path.media.clone(),
            });
        }
    }

    /// Adds the reflected and the refracted ray of a hit to the next wave, unless they are too deep or too faint.
    fn send_on(&self, hit: &Meeting, depth: u32, next: &mut Vec<Path>, census: &mut Census) {
        let onward = hit.onward();
        let rays = [
            (onward.reflected, &mut census.reflected),
            (onward.refracted, &mut census.refracted),
        ];
        for (path, count) in rays {
            let Some(path) = path else { continue };
            if path.weight.max_element() < FAINTEST {
                census.too_faint += 1;
            } else if depth >= self.depth {
                census.too_deep += 1;
            } else {
                *count += 1;
                next.push(path);
            }
        }
    }
}
