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
use super::census::sum;
use super::gain::Gain;
use super::light::Lamp;
use super::lighting::{LIGHTING, Lighting};
use super::lit::{Face, Lit, Shine};
use super::looks::Looks;
use super::onward::Senders;
use super::palette::Palette;
use super::shadow::{Obstacles, Shadowed, darken};
use super::sky::radiance;
use super::wave::{Meetings, Paths, Wave};
use super::{Census, Features, Surfaces};
use crate::field::{Level, Task, run_at};
use crate::num::{BATCH, Columns, Rows};
use crate::scene::{Fog, Scene, Sky};
use crate::trace::{Beam, Outcomes, Rays, Verdict, Visibility, count};
use glam::DVec3;
use std::cell::Cell;
use std::mem;

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
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Received {
    /// The radiance along each ray, linear RGB, by channel.
    pub radiance: Columns<3>,
    /// Whether the tracer could not tell what this ray, or one that it led to, hits.
    pub unknown: Vec<bool>,
}

impl Received {
    /// Forgets all of it, for that many rays; their light begins with [`Received::gather`].
    fn reset(&mut self, rays: usize) {
        self.radiance.resize(0);
        self.unknown.clear();
        self.unknown.resize(rays, false);
    }

    /// Adds light to these samples, each once and in order, with the instructions of a level.
    fn add(&mut self, samples: &[u32], light: [&[f64]; 3], level: Level) {
        let sums = self.radiance.columns_mut();
        let more = Brighten {
            sums,
            samples,
            light,
        };
        run_at(level, more);
    }

    /// Adds light to these samples, after which `light` has any numbers. The first light there is, which has to be that of all rays
    /// in order, is taken as it is.
    fn gather(&mut self, samples: &[u32], light: &mut Columns<3>, level: Level) {
        if self.radiance.is_empty() {
            debug_assert!(samples.iter().copied().eq(0..self.unknown.len() as u32));
            mem::swap(&mut self.radiance, light);
        } else {
            self.add(samples, light.columns(), level);
        }
    }

    /// Marks the samples of the rays without an answer.
    fn mark(&mut self, samples: &[u32], verdicts: &[Verdict]) {
        if count(verdicts, Verdict::Unknown) > 0 {
            for (sample, verdict) in samples.iter().zip(verdicts) {
                self.unknown[*sample as usize] |= *verdict == Verdict::Unknown;
            }
        }
    }
}

/// Adds light to samples.
struct Brighten<'a> {
    sums: [&'a mut [f64]; 3],
    samples: &'a [u32],
    light: [&'a [f64]; 3],
}

impl Task for Brighten<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let rows = Rows::in_order(self.samples);
        for (sums, light) in self.sums.into_iter().zip(self.light) {
            rows.add(sums, light);
        }
    }
}

/// Memory that is used again and again.
struct Memory {
    lit: Box<Lit>,
    looks: Looks,
    /// What a wave shows without any lamp.
    glow: Columns<3>,
    /// Which hits gain something from a lamp.
    hits: Vec<u32>,
    /// What shadow rays meet.
    met: Obstacles,
    /// The hits that send rays on.
    senders: Box<Senders>,
    /// What camera rays carry.
    paths: Paths,
    /// What other rays meet.
    outcomes: Outcomes,
    /// Waves that are done with.
    spare: Vec<Wave>,
}

/// Where light is collected.
struct Studio<'a> {
    light: &'a mut Received,
    memory: &'a mut Memory,
    census: &'a mut Census,
}

thread_local! {
    static MEMORY: Cell<Option<Memory>> = const { Cell::new(None) };
}

/// Finds what the rays of a wave show without any lamp: ambient light, or the sky.
struct Glow<'a> {
    terms: &'a Columns<LIGHTING>,
    paths: &'a Paths,
    glow: &'a mut Columns<3>,
}

impl Task for Glow<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let n = self.paths.len();
        let Lighting { color, ambient, .. } = Lighting::of(self.terms.columns());
        let ambient = &ambient[..n];
        let weight = self.paths.weights().columns();
        for (k, glow) in self.glow.columns_mut().into_iter().enumerate() {
            let (glow, color, weight) = (&mut glow[..n], &color[k][..n], &weight[k][..n]);
            for i in 0..n {
                glow[i] = color[i] * ambient[i] * weight[i];
            }
        }
    }
}

/// Finds what the rays of a wave show of the sky, all of which hit nothing.
struct Above<'a> {
    sky: &'a Sky,
    direction: [&'a [f64]; 3],
    weight: &'a Columns<3>,
    glow: &'a mut Columns<3>,
}

impl Task for Above<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let n = self.weight.len();
        let [x, y, z] = self.direction.map(|column| &column[..n]);
        let [a, b, c] = self.weight.columns();
        let [red, green, blue] = self.glow.columns_mut();
        let (a, b, c) = (&a[..n], &b[..n], &c[..n]);
        let (red, green, blue) = (&mut red[..n], &mut green[..n], &mut blue[..n]);
        for i in 0..n {
            let light = radiance(self.sky, DVec3::new(x[i], y[i], z[i]));
            red[i] = a[i] * light.x;
            green[i] = b[i] * light.y;
            blue[i] = c[i] * light.z;
        }
    }
}

impl<'a, S: Surfaces + ?Sized> Whitted<'a, S> {
    /// The pipeline for the light and the settings of `scene` on these `surfaces`.
    pub fn new(scene: &Scene, surfaces: &'a S) -> Self {
        let features = Features::new(scene, surfaces);
        let lamps = scene.lights.iter().filter(|light| light.shines());
        Self {
            surfaces,
            features,
            lamps: lamps.copied().map(Lamp::new).collect(),
            sky: scene.sky,
            fog: scene.fog.filter(|_| features.fog),
            depth: scene.settings.depth,
            palette: Palette::new(surfaces.materials()),
            level: Level::best(),
        }
    }

    /// Finds the first surface on each ray, as far as one sees through the fog.
    fn nearest(&self, rays: &Rays, found: &mut Outcomes) {
        let Some(fog) = &self.fog else {
            return self.surfaces.nearest(rays, Visibility::All, found);
        };
        let mut rays = rays.clone();
        let far = sight(fog);
        let ends = rays.t_max_mut();
        ends.iter_mut().for_each(|end| *end = end.min(far));
        self.surfaces.nearest(&rays, Visibility::All, found);
    }

    /// What the camera rays hit.
    pub fn first_hits(&self, rays: &Rays, census: &mut Census) -> Outcomes {
        let mut outcomes = Outcomes::default();
        self.meet_first((rays, true), census, &mut outcomes);
        outcomes
    }

    /// As [`Whitted::first_hits`]; without asking them, if they are in a beam that [can't meet anything](Whitted::may_meet).
    /// What was in `outcomes` before is forgotten.
    pub fn meet_first(
        &self,
        (rays, may_meet): (&Rays, bool),
        census: &mut Census,
        outcomes: &mut Outcomes,
    ) {
        if !may_meet {
            outcomes.nothing(rays.len());
            return census.miss(rays.len());
        }
        census.timed(|t| &mut t.primary, || self.nearest(rays, outcomes));
        census.primary += rays.len() as u64;
        census.evaluations += sum(&outcomes.evaluations);
        let [hits, unknown] = [Verdict::Hit, Verdict::Unknown]
            .map(|verdict| count(&outcomes.verdict, verdict) as u64);
        census.hits += hits;
        census.unknown += unknown;
        census.misses += rays.len() as u64 - hits - unknown;
    }

    /// Whether any of the camera rays in a beam may meet anything; the time of asking counts as that of tracing them.
    pub fn may_meet(&self, beam: &Beam, census: &mut Census) -> bool {
        census.timed(|t| &mut t.primary, || self.surfaces.may_meet(beam))
    }

    /// What camera rays show that meet nothing, if that is the same for all of them.
    pub fn backdrop(&self) -> Option<DVec3> {
        let Sky { horizon, zenith } = self.sky;
        (horizon == zenith && self.fog.is_none()).then_some(horizon)
    }

    /// The colours of the materials that the camera rays hit, without any light, and of the sky, by channel.
    pub fn flat_colors(&self, rays: &Rays, outcomes: &Outcomes) -> Columns<3> {
        let mut looks = Looks::default();
        self.look(rays, outcomes, &mut looks);
        let mut colors = Columns::default();
        colors.append(Lighting::of(looks.terms.columns()).color);
        colors
    }

    /// Finds what the rays of a wave see.
    fn look(&self, rays: &Rays, outcomes: &Outcomes, looks: &mut Looks) {
        self.palette.look(self.surfaces, outcomes, looks);
        looks.write_sky(&self.sky, rays, self.level);
    }

    /// The light along camera rays that hit `outcomes`.
    ///
    /// # Panics
    /// If there are not as many outcomes as rays.
    pub fn light(&self, rays: &Rays, outcomes: &Outcomes, census: &mut Census) -> Received {
        let mut light = Received::default();
        self.light_into(rays, outcomes, census, &mut light);
        light
    }

    /// As [`Whitted::light`]; what was in `light` before is forgotten.
    ///
    /// # Panics
    /// If there are not as many outcomes as rays.
    pub fn light_into(
        &self,
        rays: &Rays,
        outcomes: &Outcomes,
        census: &mut Census,
        light: &mut Received,
    ) {
        assert_eq!(rays.len(), outcomes.len(), "each ray has an outcome");
        light.reset(rays.len());
        let mut memory = MEMORY.with(Cell::take).unwrap_or_else(|| Memory {
            lit: Lit::new(),
            looks: Looks::default(),
            glow: Columns::default(),
            hits: Vec::new(),
            met: Obstacles::new(),
            senders: Senders::new(),
            paths: Paths::default(),
            outcomes: Outcomes::default(),
            spare: Vec::new(),
        });
        let (mut first, mut found) = (
            mem::take(&mut memory.paths),
            mem::take(&mut memory.outcomes),
        );
        first.start(rays.len());
        let mut studio = Studio {
            light,
            memory: &mut memory,
            census,
        };
        let mut waiting = self.shade(0, rays, &mut first, outcomes, &mut studio);
        while let Some(mut wave) = waiting.pop() {
            let census = &mut *studio.census;
            census.timed(
                |t| &mut t.secondary,
                || self.nearest(&wave.rays, &mut found),
            );
            census.evaluations += sum(&found.evaluations);
            census.unknown_secondary += count(&found.verdict, Verdict::Unknown) as u64;
            let Wave { depth, rays, paths } = &mut wave;
            waiting.extend(self.shade(*depth, rays, paths, &found, &mut studio));
            studio.memory.spare.push(wave.cleared());
        }
        (memory.paths, memory.outcomes) = (first, found);
        MEMORY.with(|cell| cell.set(Some(memory)));
    }

    /// Adds what the rays of a depth receive to the light, and gives the waves that follow from them.
    fn shade(
        &self,
        depth: u32,
        rays: &Rays,
        paths: &mut Paths,
        outcomes: &Outcomes,
        studio: &mut Studio,
    ) -> Vec<Wave> {
        studio.light.mark(&paths.sample, &outcomes.verdict);
        let travels = self.features.absorbs || self.fog.is_some();
        if !travels && count(&outcomes.verdict, Verdict::Hit) == 0 {
            self.shine_through(rays, paths, studio);
            return Vec::new();
        }
        self.look(rays, outcomes, &mut studio.memory.looks);
        if travels {
            self.travel(paths, outcomes, studio);
        }
        let Memory { looks, glow, .. } = &mut *studio.memory;
        glow.resize(rays.len());
        let light = Glow {
            terms: &looks.terms,
            paths,
            glow,
        };
        run_at(self.level, light);
        studio.light.gather(&paths.sample, glow, self.level);
        let wave = Meetings {
            rays,
            paths,
            outcomes,
        };
        if self.features.lit {
            self.ask_lamps(wave, studio);
        }
        if !self.features.reflects {
            return Vec::new();
        }
        let Memory {
            looks,
            senders,
            spare,
            ..
        } = &mut *studio.memory;
        let mut next = [(); 2].map(|()| Wave {
            depth: depth + 1,
            ..spare.pop().unwrap_or_else(Wave::new)
        });
        senders.send_on(
            wave,
            (&self.palette, looks),
            (&mut next, self.depth),
            (studio.census, self.level),
        );
        let (next, unused) = next.into_iter().partition(|wave| !wave.rays.is_empty());
        spare.extend::<Vec<Wave>>(unused);
        next
    }

    /// Adds the sky where all rays of a wave hit nothing.
    fn shine_through(&self, rays: &Rays, paths: &Paths, studio: &mut Studio) {
        let glow = &mut studio.memory.glow;
        glow.resize(rays.len());
        let above = Above {
            sky: &self.sky,
            direction: rays.direction(),
            weight: paths.weights(),
            glow,
        };
        run_at(self.level, above);
        studio.light.gather(&paths.sample, glow, self.level);
    }

    /// Weakens paths over the distances that their rays went, and adds the light that fog adds to them on the way.
    fn travel(&self, paths: &mut Paths, outcomes: &Outcomes, studio: &mut Studio) {
        let glow = &mut studio.memory.glow;
        glow.resize(paths.len());
        for i in 0..paths.len() {
            let is_hit = studio.memory.looks.at(&self.palette, i).is_some();
            let distance = if is_hit {
                outcomes.t()[i]
            } else {
                f64::INFINITY
            };
            let mut weight = paths.weight(i);
            if self.features.absorbs {
                weight *= absorbed(paths.media.at(i).absorb(), distance);
            }
            let (passed, added) = self
                .fog
                .map_or((1.0, DVec3::ZERO), |fog| through_fog(&fog, distance));
            for (k, channel) in glow.columns_mut().into_iter().enumerate() {
                channel[i] = weight[k] * added[k];
            }
            for (k, channel) in paths.weight_mut().into_iter().enumerate() {
                channel[i] = weight[k] * passed;
            }
        }
        studio.light.gather(&paths.sample, glow, self.level);
    }

    /// Adds what the lamps send to a wave's hits. Lamp by lamp, so that shadow rays that are traced together go to one place.
    fn ask_lamps(&self, wave: Meetings, studio: &mut Studio) {
        let Memory {
            lit,
            looks,
            hits,
            met,
            ..
        } = &mut *studio.memory;
        let Meetings {
            rays,
            paths,
            outcomes,
        } = wave;
        let terms = &looks.terms;
        for first in (0..rays.len()).step_by(BATCH) {
            let numbers = first..rays.len().min(first + BATCH);
            if !looks.is_any_lit(numbers.clone()) {
                continue;
            }
            let samples = &paths.sample[numbers.clone()];
            let face = Face {
                lit,
                rays,
                outcomes,
                numbers,
            };
            run_at(self.level, face);
            for lamp in &self.lamps {
                let shine = Shine {
                    lit,
                    lamp,
                    rays,
                    outcomes,
                    has_halfway: self.features.halfway,
                };
                run_at(self.level, shine);
                let gain = Gain {
                    lit,
                    radiance: lamp.radiance(),
                    terms,
                    weight: paths.weights(),
                };
                run_at(self.level, gain);
                lit.list_gaining(hits);
                if hits.is_empty() {
                    continue;
                }
                let shadowed = Shadowed {
                    lit,
                    hits,
                    media: &paths.media,
                };
                let seen = (self.surfaces, &self.palette);
                let level = (&mut *studio.census, self.level);
                for hit in darken(seen, &self.features, (shadowed, met), level) {
                    studio.light.unknown[samples[hit as usize] as usize] = true;
                }
                studio.light.add(samples, lit.gained(), self.level);
            }
        }
    }
}
