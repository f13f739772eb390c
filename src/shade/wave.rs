//! Waves: all rays of one depth, in the order of their samples.

use super::medium::Media;
use crate::num::Columns;
use crate::trace::{Ray, Rays};
use glam::DVec3;

/// Waves with more rays are cut between samples, so that memory stays bounded where every hit sends two rays.
const LARGEST_WAVE: usize = 1 << 15;

/// Room that waves begin with.
const USUAL_WAVE: usize = 256;

/// What a ray of a wave carries.
#[derive(Clone, Debug)]
pub struct Path {
    /// The share of its radiance that arrives in the picture.
    pub weight: DVec3,
    /// Which camera ray it belongs to.
    pub sample: u32,
    /// What it travels in.
    pub media: Media,
}

/// What rays carry, side by side.
#[derive(Clone, Debug, Default)]
pub struct Paths {
    /// The shares of their radiance that arrive in the picture, by channel.
    pub weight: Columns<3>,
    /// Which camera rays they belong to.
    pub sample: Vec<u32>,
    /// What they travel in; none where all of them are in empty space.
    media: Vec<Media>,
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

impl Paths {
    /// Makes them those of that many camera rays, in empty space.
    pub fn start(&mut self, rays: usize) {
        self.weight.resize(rays);
        for channel in self.weight.columns_mut() {
            channel.fill(1.0);
        }
        self.sample.clear();
        self.sample.extend(0..rays as u32);
        self.media.clear();
    }

    /// None yet, with room for as many.
    fn with_capacity(count: usize) -> Self {
        Self {
            weight: Columns::with_capacity(count),
            sample: Vec::with_capacity(count),
            media: Vec::new(),
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.sample.len()
    }

    /// What ray number `i` carries.
    pub fn at(&self, i: usize) -> Path {
        Path {
            weight: self.weight(i),
            sample: self.sample[i],
            media: self.media(i).clone(),
        }
    }

    /// The weight of ray number `i`.
    pub fn weight(&self, i: usize) -> DVec3 {
        DVec3::from_array(self.weight.row(i))
    }

    /// What ray number `i` travels in.
    pub fn media(&self, i: usize) -> &Media {
        self.media.get(i).unwrap_or(&Media::EMPTY)
    }

    /// Adds a ray's.
    fn push(&mut self, path: Path) {
        if !(self.media.is_empty() && path.media.is_empty()) {
            self.media.resize(self.len(), Media::EMPTY);
            self.media.push(path.media);
        }
        self.weight.push(path.weight.to_array());
        self.sample.push(path.sample);
    }
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

    /// Adds a ray; those of a sample come one after the other.
    pub fn push(&mut self, ray: &Ray, path: Path) {
        let takes_more = |wave: &Wave| {
            wave.paths.len() < LARGEST_WAVE || wave.paths.sample.last() == Some(&path.sample)
        };
        if !self.waves.last().is_some_and(takes_more) {
            self.waves.push(Wave {
                depth: self.depth,
                rays: Rays::with_capacity(USUAL_WAVE),
                paths: Paths::with_capacity(USUAL_WAVE),
            });
        }
        if let Some(wave) = self.waves.last_mut() {
            wave.rays.push(ray);
            wave.paths.push(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::medium::Medium;
    use super::*;
    use crate::trace::Footprint;

    fn path(sample: u32, media: &Media) -> Path {
        Path {
            weight: DVec3::ONE,
            sample,
            media: media.clone(),
        }
    }

    #[test]
    fn waves_are_cut_between_samples_only() {
        let ray = Ray {
            origin: DVec3::ZERO,
            direction: DVec3::X,
            t_max: f64::INFINITY,
            footprint: Footprint {
                at_origin: 0.0,
                spread: 0.0,
            },
        };
        let mut waves = Waves::new(3);
        let each = 1000;
        for k in 0..100_000 {
            waves.push(&ray, path(k / each, &Media::EMPTY));
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
        let mut paths = Paths::default();
        for (i, media) in [&Media::EMPTY, &Media::EMPTY, &wet, &Media::EMPTY, &wet]
            .into_iter()
            .enumerate()
        {
            paths.push(path(i as u32, media));
            let found = |i: usize| paths.media(i).innermost().map(|medium| medium.part);
            assert_eq!(found(i), media.innermost().map(|medium| medium.part));
            assert!((0..=i).all(|k| found(k).is_some() == (k == 2 || k == 4)));
        }
    }
}
