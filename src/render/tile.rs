//! One tile of the picture, from its rays to its pixels.

use super::film::Pixel;
use super::statistics::Tally;
use super::{View, sampling};
use crate::scene::Settings;
use crate::shade::{Surfaces, Whitted};
use crate::trace::{Outcome, Ray, Verdict};
use glam::DVec3;
use std::time::Instant;

/// What all tiles of a picture share.
pub struct Shared<'a, S: Surfaces + ?Sized> {
    pub whitted: Whitted<'a, S>,
    pub view: View,
    pub settings: &'a Settings,
    /// Whether the light is asked for.
    pub wants_beauty: bool,
    /// Whether the flat colour is asked for.
    pub wants_color: bool,
}

/// A square of pixels.
#[derive(Clone, Debug)]
pub struct Tile {
    /// Columns and rows, in the order in which they are traced.
    pub pixels: Vec<[u32; 2]>,
}

impl Tile {
    /// The tiles of a picture of `size`, `side` pixels wide and high except at the right and lower edge, in rows.
    pub fn all(size: [u32; 2], side: u32) -> Vec<Self> {
        let corners = |n: u32| (0..n).step_by(side as usize);
        corners(size[1])
            .flat_map(|y| corners(size[0]).map(move |x| [x, y]))
            .map(|corner| Self::at(corner, size, side))
            .collect()
    }

    /// The pixels along Morton's curve: each aligned run of 64 is a block of 8 x 8, each of 256 one of 16 x 16, so that
    /// what is traced together lies together.
    fn at(corner: [u32; 2], size: [u32; 2], side: u32) -> Self {
        let width = side.min(size[0] - corner[0]);
        let height = side.min(size[1] - corner[1]);
        let square = u64::from(width.max(height).next_power_of_two());
        let pixels = (0..square * square)
            .map(|code| [even_bits(code), even_bits(code >> 1)])
            .filter(|[i, j]| *i < width && *j < height)
            .map(|[i, j]| [corner[0] + i, corner[1] + j])
            .collect();
        Self { pixels }
    }

    /// The tile's pixels, in its own order, and what they cost.
    pub fn render<S: Surfaces + ?Sized>(&self, shared: &Shared<S>) -> (Vec<Pixel>, Tally) {
        let start = Instant::now();
        let mut tally = Tally::default();
        let samples = shared.settings.samples.max(1);
        let mut sums = vec![Sum::default(); self.pixels.len()];
        for sample in 0..samples {
            let rays: Vec<Ray> = self
                .pixels
                .iter()
                .map(|&pixel| sample_ray(shared, pixel, sample))
                .collect();
            self.expose(shared, &rays, &mut sums, &mut tally);
        }
        tally.unknown_pixels = sums.iter().filter(|sum| sum.is_unknown).count() as u64;
        tally.busy = start.elapsed();
        let pixels = sums.iter().map(|sum| sum.pixel(samples)).collect();
        (pixels, tally)
    }

    /// Adds one sample of each pixel.
    fn expose<S: Surfaces + ?Sized>(
        &self,
        shared: &Shared<S>,
        rays: &[Ray],
        sums: &mut [Sum],
        tally: &mut Tally,
    ) {
        let outcomes = shared.whitted.first_hits(rays, &mut tally.census);
        for (sum, outcome) in sums.iter_mut().zip(&outcomes) {
            sum.add(outcome);
            tally.steps.add(outcome.steps);
        }
        if shared.wants_color {
            let colors = shared.whitted.flat_colors(rays, &outcomes);
            for (sum, color) in sums.iter_mut().zip(colors) {
                sum.color += color;
            }
        }
        if shared.wants_beauty {
            let light = shared.whitted.light(rays, &outcomes, &mut tally.census);
            for (i, sum) in sums.iter_mut().enumerate() {
                sum.beauty += light.radiance[i];
                sum.is_unknown |= light.unknown[i];
            }
        }
    }
}

/// The ray of a sample of a pixel.
fn sample_ray<S: Surfaces + ?Sized>(shared: &Shared<S>, pixel: [u32; 2], sample: u32) -> Ray {
    let Settings { samples, seed, .. } = *shared.settings;
    let aside = sampling::place(pixel, sample, samples, seed);
    camera_ray(&shared.view, pixel, aside)
}

/// The ray through a place of a pixel, so far from its middle.
pub(super) fn camera_ray(view: &View, pixel: [u32; 2], [dx, dy]: [f64; 2]) -> Ray {
    view.ray(f64::from(pixel[0]) + dx, f64::from(pixel[1]) + dy)
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

/// The samples of a pixel so far.
#[derive(Clone, Debug, Default)]
struct Sum {
    beauty: DVec3,
    color: DVec3,
    steps: u64,
    evaluations: u64,
    is_unknown: bool,
    nearest: Option<Outcome>,
}

impl Sum {
    fn add(&mut self, outcome: &Outcome) {
        self.steps += u64::from(outcome.steps);
        self.evaluations += u64::from(outcome.evaluations);
        self.is_unknown |= outcome.verdict == Verdict::Unknown;
        if outcome.verdict == Verdict::Hit && self.nearest.is_none_or(|n| outcome.t < n.t) {
            self.nearest = Some(*outcome);
        }
    }

    fn pixel(&self, samples: u32) -> Pixel {
        let n = f64::from(samples);
        let hit = self.nearest.as_ref();
        Pixel {
            beauty: self.beauty / n,
            color: self.color / n,
            depth: hit.map_or(f64::INFINITY, |hit| hit.t),
            normal: hit.map_or(DVec3::ZERO, |hit| hit.normal),
            steps: self.steps as f64 / n,
            evaluations: self.evaluations as f64 / n,
            verdict: match (self.is_unknown, hit) {
                (true, _) => 2.0,
                (false, Some(_)) => 1.0,
                (false, None) => 0.0,
            },
            object: hit.map_or(-1.0, |hit| f64::from(hit.part)),
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
            for side in [1, 8, 33, 64] {
                let tiles = Tile::all(size, side);
                let pixels: Vec<_> = tiles.iter().flat_map(|t| t.pixels.clone()).collect();
                let distinct: HashSet<_> = pixels.iter().copied().collect();
                assert_eq!(pixels.len(), (size[0] * size[1]) as usize);
                assert_eq!(distinct.len(), pixels.len());
                assert!(pixels.iter().all(|p| p[0] < size[0] && p[1] < size[1]));
            }
        }
    }

    #[test]
    fn runs_of_64_rays_are_blocks_of_8_by_8() {
        let tile = &Tile::all([64, 64], 64)[0];
        for run in tile.pixels.chunks(64) {
            let blocks: HashSet<_> = run.iter().map(|p| [p[0] / 8, p[1] / 8]).collect();
            assert_eq!(blocks.len(), 1);
        }
    }
}
