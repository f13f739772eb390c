//! One tile of the picture, from its rays to its pixels.

use super::exposure::Exposure;
use super::statistics::Tally;
use super::{Channel, View, sampling};
use crate::scene::Settings;
use crate::shade::{Surfaces, Whitted};
use crate::trace::Rays;
use std::time::Instant;

/// What all tiles of a picture share.
pub struct Shared<'a, S: Surfaces + ?Sized> {
    pub whitted: Whitted<'a, S>,
    pub view: View,
    pub settings: &'a Settings,
    /// What is recorded.
    pub channels: &'a [Channel],
}

/// The side of a block, in pixels: the rays of a block are traced together, with all that follows from them, so that
/// what they find does not depend on how blocks are put together to tiles.
const BLOCK: u32 = 16;

/// The numbers of each channel for the pixels of a block, which are given by column and row.
pub type Developed = (Vec<[u32; 2]>, Vec<Vec<f32>>);

/// A square of blocks.
#[derive(Clone, Copy, Debug)]
pub struct Tile {
    corner: [u32; 2],
    end: [u32; 2],
}

impl Tile {
    /// The tiles of a picture of `size`, in rows; each `side` pixels wide and high, rounded up to whole blocks, except at
    /// the right and lower edge.
    pub fn all(size: [u32; 2], side: u32) -> Vec<Self> {
        let side = side.min(size[0].max(size[1])).next_multiple_of(BLOCK);
        let tile = |corner: [u32; 2]| Self {
            corner,
            end: [0, 1].map(|i| size[i].min(corner[i] + side)),
        };
        corners([0, 0], size, side).map(tile).collect()
    }

    /// The uppermost row.
    pub fn top(&self) -> u32 {
        self.corner[1]
    }

    /// How many rows there are.
    pub fn rows(&self) -> u32 {
        self.end[1] - self.corner[1]
    }

    /// The pixels of each block: columns and rows, in the order in which they are traced.
    pub fn blocks(&self) -> impl Iterator<Item = Vec<[u32; 2]>> {
        let end = self.end;
        corners(self.corner, end, BLOCK).map(move |corner| block(corner, end))
    }

    /// The blocks' numbers, and what they cost.
    pub fn render<S: Surfaces + ?Sized>(&self, shared: &Shared<S>) -> (Vec<Developed>, Tally) {
        let start = Instant::now();
        let mut tally = Tally::default();
        let samples = shared.settings.samples.max(1);
        let expose = |block: Vec<[u32; 2]>| {
            let mut exposure = Exposure::new(shared.channels, block.len());
            for sample in 0..samples {
                let rays = sample_rays(shared, &block, sample);
                expose(shared, &rays, &mut exposure, &mut tally);
            }
            tally.unknown_pixels += exposure.unknown() as u64;
            (block, exposure.developed(samples))
        };
        let blocks = self.blocks().map(expose).collect();
        tally.busy = start.elapsed();
        (blocks, tally)
    }
}

/// The upper left corners of squares of this side that cover what lies between two corners, in rows.
fn corners(from: [u32; 2], to: [u32; 2], side: u32) -> impl Iterator<Item = [u32; 2]> {
    let steps = move |i: usize| (from[i]..to[i]).step_by(side as usize);
    steps(1).flat_map(move |y| steps(0).map(move |x| [x, y]))
}

/// The pixels of a block along Morton's curve, those beyond `end` left out: each run of 64 is a square of 8 x 8,
/// so that what is traced together lies together.
fn block(corner: [u32; 2], end: [u32; 2]) -> Vec<[u32; 2]> {
    (0..u64::from(BLOCK * BLOCK))
        .map(|code| {
            [
                corner[0] + even_bits(code),
                corner[1] + even_bits(code >> 1),
            ]
        })
        .filter(|[i, j]| *i < end[0] && *j < end[1])
        .collect()
}

/// Adds one sample of each pixel of a block.
fn expose<S: Surfaces + ?Sized>(
    shared: &Shared<S>,
    rays: &Rays,
    exposure: &mut Exposure,
    tally: &mut Tally,
) {
    let outcomes = shared.whitted.first_hits(rays, &mut tally.census);
    exposure.add_hits(&outcomes);
    outcomes
        .steps
        .iter()
        .for_each(|steps| tally.steps.add(*steps));
    if shared.channels.contains(&Channel::Color) {
        exposure.add_colors(&shared.whitted.flat_colors(rays, &outcomes));
    }
    if shared.channels.contains(&Channel::Beauty) {
        exposure.add_light(&shared.whitted.light(rays, &outcomes, &mut tally.census));
    }
}

/// The rays of a sample of some pixels.
fn sample_rays<S: Surfaces + ?Sized>(shared: &Shared<S>, pixels: &[[u32; 2]], sample: u32) -> Rays {
    let Settings { samples, seed, .. } = *shared.settings;
    let place = |pixel: &[u32; 2]| {
        let [dx, dy] = sampling::place(*pixel, sample, samples, seed);
        [f64::from(pixel[0]) + dx, f64::from(pixel[1]) + dy]
    };
    shared.view.rays(pixels.iter().map(place))
}

/// The bits at even places, moved together: pairs, then fours, and so on.
fn even_bits(code: u64) -> u32 {
    const HALVES: [(u32, u64); 5] = [
        (1, 0x3333_3333_3333_3333),
        (2, 0x0f0f_0f0f_0f0f_0f0f),
        (4, 0x00ff_00ff_00ff_00ff),
        (8, 0x0000_ffff_0000_ffff),
        (16, 0x0000_0000_ffff_ffff),
    ];
    let even = code & 0x5555_5555_5555_5555;
    HALVES
        .iter()
        .fold(even, |x, (shift, mask)| (x | x >> shift) & mask) as u32
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
                let pixels: Vec<_> = blocks.flatten().collect();
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
            .flat_map(|block| block.chunks(64))
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
                .collect::<HashSet<_>>()
        };
        assert!(
            [1, 32, 33, 1000]
                .iter()
                .all(|side| blocks(*side) == blocks(16))
        );
    }
}
