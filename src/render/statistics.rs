//! What a rendering did, in numbers.

use crate::shade::Census;
use serde::Serialize;
use std::collections::BTreeMap;
use std::ops::AddAssign;
use std::time::Duration;

/// The version of the layout of [`Statistics`] in files.
const SCHEMA: u32 = 1;

/// What a rendering did. All but the times is the same for any number of threads.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Statistics {
    /// The version of this layout.
    pub schema: u32,
    /// Width and height, in pixels.
    pub size: [u32; 2],
    /// Rays per pixel.
    pub samples: u32,
    /// Of adaptive samples, how many pixels got all of them, besides the one that each has; 0 where samples are even.
    pub refined_pixels: u64,
    /// How many threads worked.
    pub threads: usize,
    /// Rays by kind.
    pub rays: Rays,
    /// What became of the camera rays.
    pub primary: Verdicts,
    /// Rays of all other kinds whose tracing ended without an answer.
    pub unknown_secondary: u64,
    /// Pixels of which some ray ended without an answer.
    pub unknown_pixels: u64,
    /// The steps of camera rays.
    pub steps: Steps,
    /// Evaluations of fields, by rays of all kinds.
    pub evaluations: u64,
    /// Times.
    pub milliseconds: Milliseconds,
}

/// Rays by kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Rays {
    /// From the camera.
    pub primary: u64,
    /// To lights.
    pub shadow: u64,
    /// Mirrored.
    pub reflected: u64,
    /// Into or out of transparent solids.
    pub refracted: u64,
    /// Not traced, because they lay deeper than the limit.
    pub too_deep: u64,
    /// Not traced, because they weighed too little.
    pub too_faint: u64,
}

/// Verdicts of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Verdicts {
    /// They met a surface.
    pub hits: u64,
    /// They met none.
    pub misses: u64,
    /// The tracer could not tell.
    pub unknown: u64,
}

/// Steps a ray.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Steps {
    /// Their mean.
    pub mean: f64,
    /// The number that 99 % of the rays don't exceed.
    pub p99: u32,
    /// The largest number.
    pub max: u32,
    /// Numbers of steps that occurred, each with its number of rays.
    pub histogram: Vec<(u32, u64)>,
}

/// Times in milliseconds. Tracing and shading are those of all threads added up, as a clock shows them: the processor time
/// where every thread has a processor of its own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Milliseconds {
    /// Finding surfaces, by rays of all kinds.
    pub trace: f64,
    /// Of it, by rays from the camera.
    pub trace_primary: f64,
    /// Of it, by rays to lights.
    pub trace_shadow: f64,
    /// Of it, by mirrored and refracted rays.
    pub trace_secondary: f64,
    /// Everything else in the tiles: camera, materials, light.
    pub shade: f64,
    /// From the first tile to the last, as a clock shows it.
    pub wall: f64,
}

/// How many rays took how many steps.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Histogram {
    /// The numbers of rays with few steps.
    few: [u64; 32],
    /// The others.
    many: BTreeMap<u32, u64>,
}

impl Histogram {
    /// Counts a ray.
    pub fn add(&mut self, steps: u32) {
        match self.few.get_mut(steps as usize) {
            Some(count) => *count += 1,
            None => *self.many.entry(steps).or_default() += 1,
        }
    }

    /// Counts many rays.
    pub fn add_all(&mut self, steps: &[u32]) {
        // Most rays are met in closed form, and take none.
        let some = steps.iter().filter(|steps| **steps != 0).count();
        self.add_none(steps.len() - some);
        if some > 0 {
            let some = steps.iter().filter(|steps| **steps != 0);
            some.for_each(|steps| self.add(*steps));
        }
    }

    /// Counts so many rays that took no step.
    pub fn add_none(&mut self, rays: usize) {
        self.few[0] += rays as u64;
    }

    /// The numbers of steps that occurred, each with its number of rays, in order.
    fn counts(&self) -> impl Iterator<Item = (u32, u64)> {
        let few = (0..).zip(self.few).filter(|(_, rays)| *rays > 0);
        few.chain(self.many.iter().map(|(steps, rays)| (*steps, *rays)))
    }

    /// The summary; zeros where no ray was counted.
    pub fn summary(&self) -> Steps {
        let histogram: Vec<(u32, u64)> = self.counts().collect();
        let rays: u64 = histogram.iter().map(|(_, n)| n).sum();
        let steps = histogram
            .iter()
            .map(|(s, n)| u128::from(*s) * u128::from(*n));
        let steps: u128 = steps.sum();
        let mean = if rays == 0 {
            0.0
        } else {
            steps as f64 / rays as f64
        };
        let enough = rays - rays / 100;
        let mut seen = 0;
        let p99 = histogram.iter().find(|(_, n)| {
            seen += *n;
            seen >= enough
        });
        Steps {
            mean,
            p99: p99.map_or(0, |(s, _)| *s),
            max: histogram.last().map_or(0, |(s, _)| *s),
            histogram,
        }
    }
}

impl AddAssign for Histogram {
    fn add_assign(&mut self, other: Self) {
        for (count, more) in self.few.iter_mut().zip(other.few) {
            *count += more;
        }
        for (steps, rays) in other.many {
            *self.many.entry(steps).or_default() += rays;
        }
    }
}

/// What tiles add up.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Counts of rays, and the time inside of the tracer.
    pub census: Census,
    /// Steps of camera rays.
    pub steps: Histogram,
    /// Pixels of which some ray ended without an answer.
    pub unknown_pixels: u64,
    /// The time in tiles.
    pub busy: Duration,
}

impl Tally {
    /// Counts camera rays that met nothing.
    pub fn miss(&mut self, rays: usize) {
        self.census.miss(rays);
        self.steps.add_none(rays);
    }
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.census += other.census;
        self.steps += other.steps;
        self.unknown_pixels += other.unknown_pixels;
        self.busy += other.busy;
    }
}

/// How the work was laid out.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// Width and height, in pixels.
    pub size: [u32; 2],
    /// Rays per pixel.
    pub samples: u32,
    /// How many pixels got more than one of adaptive samples.
    pub refined_pixels: u64,
    /// How many threads worked.
    pub threads: usize,
    /// How long it took.
    pub wall: Duration,
}

impl Tally {
    /// The statistics of a rendering.
    pub fn statistics(&self, layout: Layout) -> Statistics {
        let c = &self.census;
        let milliseconds = |time: Duration| time.as_secs_f64() * 1e3;
        Statistics {
            schema: SCHEMA,
            size: layout.size,
            samples: layout.samples,
            refined_pixels: layout.refined_pixels,
            threads: layout.threads,
            rays: Rays {
                primary: c.primary,
                shadow: c.shadow,
                reflected: c.reflected,
                refracted: c.refracted,
                too_deep: c.too_deep,
                too_faint: c.too_faint,
            },
            primary: Verdicts {
                hits: c.hits,
                misses: c.misses,
                unknown: c.unknown,
            },
            unknown_secondary: c.unknown_secondary,
            unknown_pixels: self.unknown_pixels,
            steps: self.steps.summary(),
            evaluations: c.evaluations,
            milliseconds: Milliseconds {
                trace: milliseconds(c.tracing.total()),
                trace_primary: milliseconds(c.tracing.primary),
                trace_shadow: milliseconds(c.tracing.shadow),
                trace_secondary: milliseconds(c.tracing.secondary),
                shade: milliseconds(self.busy.saturating_sub(c.tracing.total())),
                wall: milliseconds(layout.wall),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn summary_of_a_known_distribution() {
        let mut histogram = Histogram::default();
        (1..=100).for_each(|steps| histogram.add(steps));
        let steps = histogram.summary();
        assert_eq!((steps.mean, steps.p99, steps.max), (50.5, 99, 100));
    }

    #[test]
    fn summary_of_nothing_is_zero() {
        let steps = Histogram::default().summary();
        assert_eq!((steps.mean, steps.p99, steps.max), (0.0, 0, 0));
    }
}
