//! Waves: all rays of one depth, in the order of their samples.

use super::medium::Media;
use crate::trace::Ray;
use glam::DVec3;

/// Waves with more rays are cut between samples, so that memory stays bounded where every hit sends two rays.
const LARGEST_WAVE: usize = 1 << 15;

/// A ray of a wave.
#[derive(Clone, Debug)]
pub struct Path {
    /// Where it goes.
    pub ray: Ray,
    /// The share of its radiance that arrives in the picture.
    pub weight: DVec3,
    /// Which camera ray it belongs to.
    pub sample: usize,
    /// What it travels in.
    pub media: Media,
}

/// Rays of one depth.
pub struct Wave {
    /// How often they were reflected or refracted.
    pub depth: u32,
    /// The rays.
    pub paths: Vec<Path>,
}

impl Path {
    /// The path of a camera ray, in empty space.
    pub fn from_camera((sample, ray): (usize, &Ray)) -> Self {
        Self {
            ray: *ray,
            weight: DVec3::ONE,
            sample,
            media: Media::default(),
        }
    }
}

/// The paths as waves of bounded size, each with all paths of its samples, the first on top of the stack.
pub fn cut_between_samples(depth: u32, paths: Vec<Path>) -> Vec<Wave> {
    let mut waves: Vec<Wave> = Vec::new();
    for path in paths {
        match waves.last_mut() {
            Some(Wave { paths, .. })
                if paths.len() < LARGEST_WAVE
                    || paths.last().is_some_and(|last| last.sample == path.sample) =>
            {
                paths.push(path);
            }
            _ => waves.push(Wave {
                depth,
                paths: vec![path],
            }),
        }
    }
    waves.reverse();
    waves
}
