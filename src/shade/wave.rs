//! Waves: all rays of one depth, in the order of their samples.

use super::medium::Media;
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
    pub sample: usize,
    /// What it travels in.
    pub media: Media,
}

/// Rays of one depth, and what each of them carries.
#[derive(Debug)]
pub struct Wave {
    /// How often they were reflected or refracted.
    pub depth: u32,
    /// Where they go.
    pub rays: Rays,
    /// What they carry.
    pub paths: Vec<Path>,
}

impl Path {
    /// The paths of that many camera rays, in empty space.
    pub fn from_camera(rays: usize) -> Vec<Self> {
        let path = |sample| Self {
            weight: DVec3::ONE,
            sample,
            media: Media::default(),
        };
        (0..rays).map(path).collect()
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
    pub fn push(&mut self, ray: Ray, path: Path) {
        let takes_more = |wave: &Wave| {
            wave.paths.len() < LARGEST_WAVE
                || wave
                    .paths
                    .last()
                    .is_some_and(|last| last.sample == path.sample)
        };
        if !self.waves.last().is_some_and(takes_more) {
            self.waves.push(Wave {
                depth: self.depth,
                rays: Rays::with_capacity(USUAL_WAVE),
                paths: Vec::with_capacity(USUAL_WAVE),
            });
        }
        if let Some(wave) = self.waves.last_mut() {
            wave.rays.push(&ray);
            wave.paths.push(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::Footprint;

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
            let path = Path {
                weight: DVec3::ONE,
                sample: k / each,
                media: Media::default(),
            };
            waves.push(ray, path);
        }
        let mut next = 0;
        for wave in &waves.waves {
            assert_eq!((wave.depth, wave.rays.len()), (3, wave.paths.len()));
            assert!(wave.paths.len() < LARGEST_WAVE + each);
            assert_eq!(wave.paths[0].sample, next);
            next = wave.paths[wave.paths.len() - 1].sample + 1;
        }
        assert_eq!((next, waves.waves.len()), (100, 4));
    }
}
