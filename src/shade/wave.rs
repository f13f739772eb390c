//! Waves: all rays of one depth, in the order of their samples.

use super::medium::{Media, Surroundings};
use crate::num::Columns;
use crate::trace::{Outcomes, Rays};
use glam::DVec3;

/// Waves with more rays are cut between samples, so that memory stays bounded where every hit sends two rays.
const LARGEST_WAVE: usize = 1 << 15;

/// Room that waves begin with.
const USUAL_WAVE: usize = 256;

/// What rays carry, side by side.
#[derive(Clone, Debug, Default)]
pub struct Paths {
    /// The shares of their radiance that arrive in the picture, by channel.
    weight: Columns<3>,
    /// Which camera rays they belong to.
    pub sample: Vec<u32>,
    /// What they travel in.
    pub media: Surroundings,
    /// Whether they are as [`Paths::start`] made them.
    is_fresh: bool,
}

/// Rays of one depth, and what each of them carries.
#[derive(Debug)]
pub struct Wave {
    /// How often they were reflected or refracted.
    pub depth: u32,
    /// Where they go.
    pub rays: Rays,
    /// What they carry.
    pub paths: Paths,
}

impl Wave {
    /// No rays.
    fn new() -> Self {
        Self {
            depth: 0,
            rays: Rays::with_capacity(USUAL_WAVE),
            paths: Paths::with_capacity(USUAL_WAVE),
        }
    }

    /// Without its rays, for others.
    pub fn cleared(mut self) -> Self {
        self.rays.clear();
        self.paths.weight.resize(0);
        self.paths.sample.clear();
        self.paths.media.clear();
        self
    }
}

impl Paths {
    /// Makes them those of that many camera rays, in empty space.
    pub fn start(&mut self, rays: usize) {
        if self.is_fresh && self.len() == rays {
            return;
        }
        self.is_fresh = true;
        self.weight.fill(rays, 1.0);
        self.sample.clear();
        self.sample.extend(0..rays as u32);
        self.media = Surroundings::empty(rays);
    }

    /// None yet, with room for as many.
    fn with_capacity(count: usize) -> Self {
        Self {
            weight: Columns::with_capacity(count),
            sample: Vec::with_capacity(count),
            media: Surroundings::default(),
            is_fresh: false,
        }
    }

    /// The weights, to be changed, by channel.
    pub fn weight_mut(&mut self) -> [&mut [f64]; 3] {
        self.is_fresh = false;
        self.weight.columns_mut()
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.sample.len()
    }

    /// The weights, by channel.
    pub fn weights(&self) -> &Columns<3> {
        &self.weight
    }

    /// Whether it is known that all weigh 1.
    pub fn are_full(&self) -> bool {
        self.is_fresh
    }

    /// The weight of ray number `i`.
    pub fn weight(&self, i: usize) -> DVec3 {
        DVec3::from_array(self.weight.row(i))
    }
}

/// Rays of one depth with what they carry and met.
#[derive(Clone, Copy)]
pub struct Meetings<'a> {
    /// The rays.
    pub rays: &'a Rays,
    /// What they carry.
    pub paths: &'a Paths,
    /// What they met.
    pub outcomes: &'a Outcomes,
}

/// The waves that follow from another, of bounded size, each with all rays of its samples.
#[derive(Debug)]
pub struct Waves {
    /// How often their rays were reflected or refracted.
    pub depth: u32,
    /// The first samples are in the first wave.
    pub waves: Vec<Wave>,
}

impl Waves {
    /// No waves yet, for rays of this depth.
    pub fn new(depth: u32) -> Self {
        Self {
            depth,
            waves: Vec::new(),
        }
    }

    /// Adds the rays of these numbers of columns: where they go, and what each weighs, belongs to and travels in, which is empty
    /// space for all of them without `media`. Those of a sample come one after the other. Waves that are done with are used
    /// again.
    pub fn take<'a>(
        &mut self,
        (numbers, spare): (&[u32], &mut Vec<Wave>),
        (rays, weight): ([&[f64]; Rays::COLUMNS], [&[f64]; 3]),
        sample: impl Fn(u32) -> u32,
        media: Option<impl Fn(u32) -> &'a Media>,
    ) {
        let mut left = numbers;
        while !left.is_empty() {
            let last = self.waves.last();
            let some = match last {
                Some(wave) if wave.paths.len() >= LARGEST_WAVE => {
                    let last = wave.paths.sample.last().copied();
                    let same = left.iter().take_while(|k| Some(sample(**k)) == last);
                    same.count()
                }
                Some(_) => left.len().min(LARGEST_WAVE),
                None => 0,
            };
            if some == 0 {
                let mut wave = spare.pop().unwrap_or_else(Wave::new);
                wave.depth = self.depth;
                self.waves.push(wave);
                continue;
            }
            let (some, rest) = left.split_at(some);
            if let Some(wave) = self.waves.last_mut() {
                wave.rays.pick(rays, some);
                wave.paths.weight.pick(weight, some);
                let paths = &mut wave.paths;
                paths.is_fresh = false;
                paths.sample.extend(some.iter().map(|k| sample(*k)));
                match &media {
                    Some(media) => some.iter().for_each(|k| paths.media.push(media(*k))),
                    None => paths.media.push_all(&Media::EMPTY, some.len()),
                }
            }
            left = rest;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::medium::Medium;
    use super::*;
    use glam::DVec3;

    /// Adds as many rays, whose samples and media these are.
    fn add(waves: &mut Waves, count: u32, sample: impl Fn(u32) -> u32, media: &[Media]) {
        add_to(waves, count, sample, (media, &mut Vec::new()));
    }

    /// The same, with waves that are done with.
    fn add_to(
        waves: &mut Waves,
        count: u32,
        sample: impl Fn(u32) -> u32,
        (media, spare): (&[Media], &mut Vec<Wave>),
    ) {
        let column: Vec<f64> = (0..count).map(f64::from).collect();
        let numbers: Vec<u32> = (0..count).collect();
        let columns = ([&column[..]; Rays::COLUMNS], [&column[..]; 3]);
        let media_of = |k: u32| &media[k as usize % media.len()];
        let are_empty = media.iter().all(Media::is_empty);
        waves.take(
            (&numbers, spare),
            columns,
            sample,
            (!are_empty).then_some(media_of),
        );
    }

    #[test]
    fn waves_are_cut_between_samples_only() {
        let mut waves = Waves::new(3);
        let (each, chunk) = (1000, 256);
        for first in (0..100_000).step_by(chunk) {
            let count = (100_000 - first).min(chunk);
            let sample = |k: u32| (first as u32 + k) / each;
            add(&mut waves, count as u32, sample, &[Media::EMPTY]);
        }
        let mut next = 0;
        for wave in &waves.waves {
            assert_eq!((wave.depth, wave.rays.len()), (3, wave.paths.len()));
            assert!(wave.paths.len() < LARGEST_WAVE + each as usize);
            assert_eq!(wave.paths.sample[0], next);
            next = wave.paths.sample[wave.paths.len() - 1] + 1;
        }
        assert_eq!((next, waves.waves.len()), (100, 4));
    }

    #[test]
    fn media_are_those_of_each_ray() {
        let water = Medium {
            part: 3,
            material: 0,
            ior: 1.33,
            absorb: DVec3::ZERO,
        };
        let wet = Media::EMPTY.entering(water).beyond;
        let media = [Media::EMPTY, Media::EMPTY, wet.clone(), Media::EMPTY, wet];
        // In a wave that held other rays.
        let mut before = Waves::new(7);
        add(&mut before, 9, |k| k + 100, &media[2..3]);
        let mut spare: Vec<Wave> = before.waves.into_iter().map(Wave::cleared).collect();
        let mut waves = Waves::new(1);
        for count in [2, 5, 1, 10] {
            add_to(&mut waves, count, |k| k, (&media, &mut spare));
        }
        assert!(spare.is_empty());
        assert_eq!((waves.waves.len(), waves.waves[0].depth), (1, 1));
        let paths = &waves.waves[0].paths;
        let order = [2, 5, 1, 10].into_iter().flat_map(|count| 0..count);
        for (i, k) in order.enumerate() {
            let found = paths.media.at(i).innermost().map(|medium| medium.part);
            assert_eq!(found, [None, None, Some(3), None, Some(3)][k % 5]);
            assert_eq!(paths.weight(i), DVec3::splat(k as f64));
            assert_eq!(paths.sample[i], k as u32);
        }
        assert_eq!(paths.len(), 18);
    }
}
