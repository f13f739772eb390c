//! What the camera's rays hit, ray by ray, in full precision: for judging and for counting.

use super::block::Block;
use super::job::on_threads;
use super::statistics::Tally;
use super::tile::Tile;
use super::{RenderOptions, Steps, View};
use crate::scene::Scene;
use crate::shade::{Census, Surfaces, Whitted};
use crate::trace::{Outcome, Outcomes, Ray};

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
            let (mut hits, mut outcomes) = (Self::default(), Outcomes::default());
            for area in tile.areas() {
                let rays = view.rays(Block::of(&area).pixels());
                let may_meet = whitted.may_meet(&view.beam(&area), &mut hits.census);
                whitted.meet_first((&rays, may_meet), &mut hits.census, &mut outcomes);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{AnyPrimitive, Torus};
    use crate::scene::Node;
    use crate::shade::Surfaces;
    use crate::trace::{Verdict, Visibility, World};

    #[test]
    fn blocks_that_meet_nothing_hit_what_their_rays_do() {
        let ring = Node::primitive(AnyPrimitive::Torus(Torus::new(0.8, 0.2))).expect("a ring");
        let mut scene = Scene {
            shown: vec![ring],
            ..Scene::default()
        };
        scene.settings.size = [90, 70];
        let world = World::new(&scene).expect("a world");
        let hits = Hits::of(&scene, &world, 0);
        let view = View::new(&scene.camera, scene.settings.size);
        let tiles = Tile::all(scene.settings.size, RenderOptions::default().tile);
        let areas: Vec<_> = tiles.iter().flat_map(Tile::areas).collect();
        let is_empty = |area: &&_| !Surfaces::may_meet(&world, &view.beam(area));
        let empty = areas.iter().filter(is_empty).count();
        assert!(empty > 5 && empty + 5 < areas.len(), "{empty} are empty");
        assert_eq!(hits.outcomes, world.nearest(&hits.rays, Visibility::All));
        let of = |verdict| {
            hits.outcomes
                .iter()
                .filter(|o| o.verdict == verdict)
                .count() as u64
        };
        let Census {
            hits: met,
            misses,
            primary,
            ..
        } = hits.census;
        assert_eq!([met, misses], [Verdict::Hit, Verdict::Miss].map(of));
        assert_eq!(primary, 90 * 70);
    }
}
