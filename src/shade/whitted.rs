//! Whitted's recursion as a loop over waves.
//!
//! ```text
//! camera rays -> trace -> shade -> reflected and refracted rays -> trace -> shade -> ... until the depth limit
//!                           |
//!                           +--> shadow rays, a batch of their own
//! ```
//!
//! A wave is all rays of one depth and kind; each knows the pixel sample that it adds to and by which weight. The rays of a
//! sample, and the waves that they are in, keep their order, so the sum of a sample has the same bits however the samples are
//! batched. Source: Whitted 1980.

use super::attenuation::{absorbed, sight, through_fog};
use super::light::Lamp;
use super::lit::{CHUNK, Face, Lit, Shine};
use super::meeting::{Meeting, Onward};
use super::palette::{Looks, Palette};
use super::shadow::{ShadowRays, passages};
use super::wave::{Path, Wave, Waves};
use super::{Census, Features, Surface, Surfaces, phong, sky};
use crate::field::{Level, run_at};
use crate::scene::{Fog, Scene, Sky};
use crate::trace::{Outcomes, Rays, Verdict, Visibility};
use glam::DVec3;
use std::cell::Cell;

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
    palette: Palette,
    /// The instructions that lanes use.
    level: Level,
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
struct Gains {
    rays: ShadowRays,
    samples: Vec<usize>,
    radiance: Vec<DVec3>,
}

/// Where light is collected.
struct Studio<'a> {
    light: &'a mut Received,
    lit: &'a mut Lit,
    census: &'a mut Census,
}

/// Rays of one depth with what they carry and met.
struct Meetings<'a> {
    rays: &'a Rays,
    paths: &'a [Path],
    outcomes: &'a Outcomes,
    looks: &'a Looks<'a>,
}

thread_local! {
    /// Memory that is used again and again.
    static LIT: Cell<Option<Box<Lit>>> = const { Cell::new(None) };
}

impl Gains {
    /// None yet, with room for as many.
    fn up_to(count: usize) -> Self {
        Self {
            rays: ShadowRays {
                rays: Rays::with_capacity(count),
                media: Vec::new(),
            },
            samples: Vec::with_capacity(count),
            radiance: Vec::with_capacity(count),
        }
    }
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
            palette: Palette::new(surfaces.materials()),
            level: Level::best(),
        }
    }

    /// The stages that the scene compiled in.
    pub fn features(&self) -> Features {
        self.features
    }

    /// The first surface on each ray, as far as one sees through the fog.
    fn nearest(&self, rays: &Rays) -> Outcomes {
        let Some(fog) = &self.fog else {
            return self.surfaces.nearest(rays, Visibility::All);
        };
        let mut rays = rays.clone();
        let far = sight(fog);
        let ends = rays.t_max_mut();
        ends.iter_mut().for_each(|end| *end = end.min(far));
        self.surfaces.nearest(&rays, Visibility::All)
    }

    /// What the camera rays hit.
    pub fn first_hits(&self, rays: &Rays, census: &mut Census) -> Outcomes {
        let outcomes = census.timed(|t| &mut t.primary, || self.nearest(rays));
        census.primary += rays.len() as u64;
        census.evaluations += sum(&outcomes.evaluations);
        for verdict in &outcomes.verdict {
            match verdict {
                Verdict::Hit => census.hits += 1,
                Verdict::Miss => census.misses += 1,
                Verdict::Unknown => census.unknown += 1,
            }
        }
        outcomes
    }

    /// The colours of the materials that the camera rays hit, without any light, and of the sky.
    pub fn flat_colors(&self, rays: &Rays, outcomes: &Outcomes) -> Vec<DVec3> {
        let looks = self.palette.looks(self.surfaces, outcomes);
        let color = |i: usize| match looks.at(i) {
            Some(surface) => surface.color,
            None => self.sky_along(rays, i),
        };
        (0..rays.len()).map(color).collect()
    }

    /// The light along camera rays that hit `outcomes`.
    pub fn light(&self, rays: &Rays, outcomes: &Outcomes, census: &mut Census) -> Received {
        let mut light = Received {
            radiance: vec![DVec3::ZERO; rays.len()],
            unknown: vec![false; rays.len()],
        };
        let mut lit = LIT.with(Cell::take).unwrap_or_else(Lit::new);
        let mut studio = Studio {
            light: &mut light,
            lit: &mut lit,
            census,
        };
        let paths = Path::from_camera(rays.len());
        let mut waiting = self.shade(0, rays, paths, outcomes, &mut studio);
        while let Some(wave) = waiting.pop() {
            let census = &mut *studio.census;
            let outcomes = census.timed(|t| &mut t.secondary, || self.nearest(&wave.rays));
            census.evaluations += sum(&outcomes.evaluations);
            let is_unknown = |verdict: &&Verdict| **verdict == Verdict::Unknown;
            census.unknown_secondary += outcomes.verdict.iter().filter(is_unknown).count() as u64;
            let Wave { depth, rays, paths } = wave;
            waiting.extend(self.shade(depth, &rays, paths, &outcomes, &mut studio));
        }
        LIT.with(|cell| cell.set(Some(lit)));
        light
    }

    /// Adds what the rays of a depth receive to the light, and gives the waves that follow from them.
    fn shade(
        &self,
        depth: u32,
        rays: &Rays,
        mut paths: Vec<Path>,
        outcomes: &Outcomes,
        studio: &mut Studio,
    ) -> Vec<Wave> {
        let looks = self.palette.looks(self.surfaces, outcomes);
        let light = &mut *studio.light;
        for (i, path) in paths.iter_mut().enumerate() {
            let sample = path.sample;
            light.unknown[sample] |= outcomes.verdict[i] == Verdict::Unknown;
            let surface = looks.at(i);
            let distance = surface.map_or(f64::INFINITY, |_| outcomes.t()[i]);
            light.radiance[sample] += self.travel(path, distance);
            light.radiance[sample] += match surface {
                Some(surface) => path.weight * phong::ambient(surface),
                // Nothing of the sky may be left on the infinite way.
                None if path.weight == DVec3::ZERO => DVec3::ZERO,
                None => path.weight * self.sky_along(rays, i),
            };
        }
        let wave = Meetings {
            rays,
            paths: &paths,
            outcomes,
            looks: &looks,
        };
        if self.features.lit {
            self.ask_lamps(&wave, studio);
        }
        let mut next = [(); 2].map(|()| Waves::new(depth + 1));
        if self.features.reflects {
            for (i, path) in paths.iter().enumerate() {
                if let Some(surface) = looks.at(i).filter(|surface| surface.sends_on()) {
                    let (ray, outcome) = (rays.at(i), outcomes.at(i));
                    let hit = Meeting::new(&ray, path, &outcome, surface);
                    self.send_on(&hit, &mut next, studio.census);
                }
            }
        }
        let [mut waves, refracted] = next.map(|waves| waves.waves);
        waves.extend(refracted);
        waves
    }

    /// The sky behind a ray.
    fn sky_along(&self, rays: &Rays, i: usize) -> DVec3 {
        let [x, y, z] = rays.direction();
        sky::radiance(&self.sky, DVec3::new(x[i], y[i], z[i]))
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

    /// Adds what the lamps send to a wave's hits. Lamp by lamp, so that shadow rays that are traced together go to one place.
    fn ask_lamps(&self, wave: &Meetings, studio: &mut Studio) {
        let count = wave.rays.len();
        let mut gains: Vec<Gains> = self.lamps.iter().map(|_| Gains::up_to(count)).collect();
        let is_lit = |i: usize| wave.looks.at(i).is_some_and(Surface::is_lit);
        for first in (0..wave.rays.len()).step_by(CHUNK) {
            let numbers = first..wave.rays.len().min(first + CHUNK);
            if !numbers.clone().any(is_lit) {
                continue;
            }
            let (rays, outcomes) = (wave.rays, wave.outcomes);
            let lit = &mut *studio.lit;
            run_at(
                self.level,
                Face {
                    lit,
                    rays,
                    outcomes,
                    numbers,
                },
            );
            for (lamp, gains) in self.lamps.iter().zip(&mut gains) {
                run_at(
                    self.level,
                    Shine {
                        lit,
                        lamp,
                        rays,
                        outcomes,
                    },
                );
                self.collect(wave, lamp, lit, gains);
            }
        }
        for gains in gains {
            let Gains {
                rays,
                samples,
                radiance,
            } = gains;
            let passed = passages(
                (self.surfaces, &self.palette),
                &self.features,
                &rays,
                studio.census,
            );
            for (i, passage) in passed.iter().enumerate() {
                studio.light.radiance[samples[i]] += radiance[i] * passage.share;
                studio.light.unknown[samples[i]] |= passage.unknown;
            }
        }
    }

    /// Collects what a lamp adds at hits if nothing is in the way, with the rays that find out.
    fn collect(&self, wave: &Meetings, lamp: &Lamp, lit: &Lit, gains: &mut Gains) {
        let mut hits: Vec<u32> = Vec::with_capacity(CHUNK);
        for (i, number) in lit.numbers.clone().enumerate() {
            let (strength, cosines) = lit.shine(i);
            if strength == 0.0 || cosines.light.is_nan() || cosines.light <= 0.0 {
                continue;
            }
            let Some(surface) = wave.looks.at(number) else {
                continue;
            };
            let seen = phong::reflectance(surface, &cosines);
            let radiance = lamp.radiance() * strength;
            if seen == DVec3::ZERO || radiance == DVec3::ZERO {
                continue;
            }
            let path = &wave.paths[number];
            hits.push(i as u32);
            if self.features.tinted_shadows {
                gains.rays.media.push(path.media.clone());
            }
            gains.samples.push(path.sample);
            gains.radiance.push(path.weight * seen * radiance);
        }
        lit.shadow_rays(&hits, &mut gains.rays.rays);
    }

    /// Adds the reflected and the refracted ray of a hit to the next waves of each kind, unless they are too deep or too
    /// faint.
    fn send_on(&self, hit: &Meeting, next: &mut [Waves; 2], census: &mut Census) {
        let [mirrored, through] = next;
        let Onward {
            reflected,
            refracted,
        } = hit.onward();
        if let Some(weight) = self.passing(hit, reflected.share, mirrored, census) {
            census.reflected += 1;
            let ray = hit.leaving(hit.normal, reflected.direction);
            mirrored.push(
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
        if let Some(weight) = self.passing(hit, branch.share, through, census) {
            census.refracted += 1;
            let ray = hit.leaving(-hit.normal, branch.direction);
            let path = Path {
                weight,
                sample: hit.path.sample,
                media: crossing.beyond,
            };
            through.push(ray, path);
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

fn sum(counts: &[u32]) -> u64 {
    counts.iter().map(|count| u64::from(*count)).sum()
}
