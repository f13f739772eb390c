//! One tile of the picture, from its rays to its pixels.

use super::area::Area;
use super::block::{BLOCK, Block};
use super::exposure::Exposure;
use super::film::Patch;
use super::refine::Refined;
use super::statistics::Tally;
use super::{Channel, View, sampling};
use crate::shade::{Received, Surfaces, Whitted};
use crate::trace::{Outcomes, Rays};
use glam::DVec3;
use std::cell::Cell;
use std::time::Instant;

/// What all tiles of a picture share.
pub struct Shared<'a, S: Surfaces + ?Sized> {
    pub whitted: Whitted<'a, S>,
    pub view: View,
    /// What random choices start from.
    pub seed: u64,
    /// Rays per pixel.
    pub samples: u32,
    /// The only pixels that are recorded; none for all.
    pub refined: Option<&'a Refined>,
    /// What is recorded.
    pub channels: &'a [Channel],
}

impl<S: Surfaces + ?Sized> Shared<'_, S> {
    /// What is recorded of rays that meet nothing, if it is the same for all of them.
    fn backdrop(&self) -> Option<DVec3> {
        if self.refined.is_some() {
            return None;
        }
        let shows = |channel| self.channels.contains(channel);
        if [Channel::Beauty, Channel::Color].iter().any(shows) {
            self.whitted.backdrop()
        } else {
            Some(DVec3::ZERO)
        }
    }
}

/// A square of blocks.
#[derive(Clone, Copy, Debug)]
pub struct Tile(Area);

impl Tile {
    /// The tiles of a picture of `size`, in rows; each `side` pixels wide and high, rounded up to whole blocks, except at
    /// the right and lower edge.
    pub fn all(size: [u32; 2], side: u32) -> Vec<Self> {
        let side = side.min(size[0].max(size[1])).next_multiple_of(BLOCK);
        Area::of(size).squares(side).map(Self).collect()
    }

    /// The width and height.
    pub fn size(&self) -> [u32; 2] {
        self.0.size()
    }

    /// The areas of its blocks, in the order in which they are traced.
    pub fn areas(&self) -> impl Iterator<Item = Area> + use<> {
        self.0.squares(BLOCK)
    }

    /// Its blocks, in the same order.
    pub fn blocks(&self) -> impl Iterator<Item = Block> + use<> {
        self.areas().map(|area| Block::of(&area))
    }

    /// Records the tile on its patch of the film; gives what it cost.
    pub fn render<S: Surfaces + ?Sized>(&self, shared: &Shared<S>, patch: &mut Patch) -> Tally {
        let start = Instant::now();
        let mut tally = Tally::default();
        let samples = shared.samples;
        let mut desk = DESK.with(Cell::take).unwrap_or_default();
        let mut exposure = Exposure::new(shared.channels);
        let mut block = Block::default();
        let mut even = None;
        for area in self.areas() {
            if let Some(refined) = shared.refined {
                block.choose(&area, |pixel| refined.needs(pixel));
                if block.pixels().is_empty() {
                    continue;
                }
            }
            let beam = shared.view.beam(&area);
            let may_meet = shared.whitted.may_meet(&beam, &mut tally.census);
            if !may_meet && let Some(color) = shared.backdrop() {
                tally.miss(area.pixels() * samples as usize);
                even.get_or_insert_with(|| Exposure::even(shared.channels, samples, color))
                    .develop_all(samples, &area, patch);
                continue;
            }
            if shared.refined.is_none() {
                block.move_to(&area);
            }
            exposure.reset(block.pixels().len());
            for sample in 0..samples {
                desk.aim(shared, block.pixels(), sample);
                desk.meet(shared, may_meet, &mut tally);
                desk.expose(shared, &mut exposure, &mut tally);
            }
            tally.unknown_pixels += exposure.unknown() as u64;
            exposure.develop(samples, &block, patch);
        }
        DESK.with(|cell| cell.set(Some(desk)));
        tally.busy = start.elapsed();
        tally
    }
}

thread_local! {
    static DESK: Cell<Option<Desk>> = const { Cell::new(None) };
}

/// The rays of a sample of some pixels; memory that is used again for the next.
#[derive(Default)]
struct Desk {
    rays: Rays,
    outcomes: Outcomes,
    light: Received,
}

impl Desk {
    /// Takes a sample of each of these pixels.
    fn aim<S: Surfaces + ?Sized>(&mut self, shared: &Shared<S>, pixels: &[[u32; 2]], sample: u32) {
        let (samples, seed) = (shared.samples, shared.seed);
        let aside = |pixel| sampling::place(pixel, sample, samples, seed);
        shared.view.aim(pixels, aside, &mut self.rays);
    }

    /// Finds what the rays meet, if they may meet anything.
    fn meet<S: Surfaces + ?Sized>(
        &mut self,
        shared: &Shared<S>,
        may_meet: bool,
        tally: &mut Tally,
    ) {
        let rays = (&self.rays, may_meet);
        let whitted = &shared.whitted;
        whitted.meet_first(rays, &mut tally.census, &mut self.outcomes);
        tally.steps.add_all(&self.outcomes.steps);
    }

    /// Adds what is seen along the rays.
    fn expose<S: Surfaces + ?Sized>(
        &mut self,
        shared: &Shared<S>,
        exposure: &mut Exposure,
        tally: &mut Tally,
    ) {
        let Self {
            rays,
            outcomes,
            light,
        } = self;
        let whitted = &shared.whitted;
        exposure.add_hits(outcomes);
        if shared.channels.contains(&Channel::Color) {
            exposure.add_colors(&whitted.flat_colors(rays, outcomes));
        }
        if shared.channels.contains(&Channel::Beauty) {
            whitted.light_into(rays, outcomes, &mut tally.census, light);
            exposure.add_light(light);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn tiles_cover_every_pixel_once() {
        for size in [[1, 1], [7, 5], [64, 64], [130, 67], [3, 200]] {
            for side in [1, 8, 33, 64, u32::MAX] {
                let tiles = Tile::all(size, side);
                let blocks = tiles.iter().flat_map(Tile::blocks);
                let pixels: Vec<_> = blocks.flat_map(|block| block.pixels().to_vec()).collect();
                let distinct: HashSet<_> = pixels.iter().copied().collect();
                assert_eq!(pixels.len(), (size[0] * size[1]) as usize);
                assert_eq!(distinct.len(), pixels.len());
                assert!(pixels.iter().all(|p| p[0] < size[0] && p[1] < size[1]));
            }
        }
    }

    #[test]
    fn runs_of_64_rays_are_squares_of_8_by_8() {
        for run in Tile::all([64, 64], 64)[0]
            .blocks()
            .collect::<Vec<_>>()
            .iter()
            .flat_map(|block| block.pixels().chunks(64))
        {
            let squares: HashSet<_> = run.iter().map(|p| [p[0] / 8, p[1] / 8]).collect();
            assert_eq!((run.len(), squares.len()), (64, 1));
        }
    }

    #[test]
    fn blocks_are_the_same_for_all_tiles() {
        let blocks = |side| {
            let tiles = Tile::all([130, 67], side);
            tiles
                .into_iter()
                .flat_map(|tile| tile.blocks().collect::<Vec<_>>())
                .map(|block| block.pixels().to_vec())
                .collect::<HashSet<_>>()
        };
        assert!(
            [1, 32, 33, 1000]
                .iter()
                .all(|side| blocks(*side) == blocks(16))
        );
    }
}
