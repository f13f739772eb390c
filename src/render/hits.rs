//! What the camera's rays hit, ray by ray, in full precision: for judging and for counting.

use super::job::on_threads;
use super::statistics::Tally;
use super::tile::Tile;
use super::{RenderOptions, Steps, View};
use crate::scene::Scene;
use crate::shade::{Census, Surfaces, Whitted};
use crate::trace::{Outcome, Ray};

/// What the camera's rays hit.
#[derive(Clone, Debug, Default)]
pub struct Hits {
    /// The rays: one through the middle of each pixel, tile by tile.
    pub rays: Vec<Ray>,
    /// What each of them found.
    pub outcomes: Vec<Outcome>,
    /// What it took.
    pub census: Census,
}

impl Hits {
    /// What the rays through the middles of the pixels of `scene` hit in `world`: tile by tile as a rendering traces them, on
    /// that many threads, or 0 for one on each processor.
    pub fn of<S: Surfaces + ?Sized>(scene: &Scene, world: &S, threads: usize) -> Self {
        let settings = &scene.settings;
        let view = View::new(&scene.camera, settings.size);
        let whitted = Whitted::new(scene, world);
        let tiles = Tile::all(settings.size, RenderOptions::default().tile);
        let trace = |tile: &Tile| {
            let mut hits = Self::default();
            for block in tile.blocks() {
                let rays = view.rays(block.pixels());
                let outcomes = whitted.first_hits(&rays, &mut hits.census);
                hits.outcomes.extend(outcomes.iter());
                hits.rays.extend(rays.iter());
            }
            hits
        };
        let (parts, _) = on_threads(threads, &tiles, trace);
        parts.into_iter().fold(Self::default(), Self::joined)
    }

    fn joined(mut self, other: Self) -> Self {
        self.rays.extend(other.rays);
        self.outcomes.extend(other.outcomes);
        self.census += other.census;
        self
    }

    /// How many rays took how many steps.
    pub fn steps(&self) -> Steps {
        let mut tally = Tally::default();
        self.outcomes
            .iter()
            .for_each(|outcome| tally.steps.add(outcome.steps));
        tally.steps.summary()
    }

    /// Evaluations of fields a ray.
    pub fn evaluations(&self) -> f64 {
        self.census.evaluations as f64 / self.rays.len().max(1) as f64
    }

    /// The time inside of the tracer, in milliseconds.
    pub fn milliseconds(&self) -> f64 {
        self.census.tracing.total().as_secs_f64() * 1e3
    }
}
