//! Waves: all rays of one depth and kind, in the order of their samples.

use super::medium::Surroundings;
use crate::num::{BATCH, Columns};
use crate::trace::{Outcomes, RayColumns, Rays};
use glam::DVec3;

/// What rays carry, side by side.
#[derive(Clone, Debug, Default)]
pub struct Paths {
    /// The shares of their radiance that arrive in the picture, by channel.
    weight: Columns<3>,
    /// Which camera rays they belong to: each to another, in order.
    pub sample: Vec<u32>,
    /// What they travel in.
    pub media: Surroundings,
    /// Whether they are as [`Paths::start`] made them.
    is_fresh: bool,
}

/// Rays of one depth and kind, and what each of them carries.
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
    pub fn new() -> Self {
        Self {
            depth: 0,
            rays: Rays::with_capacity(BATCH),
            paths: Paths::with_capacity(BATCH),
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

    /// Adds the rays with these numbers of columns: where they go, and what each weighs, belongs to and travels in.
    pub fn take(
        &mut self,
        numbers: &[u32],
        (rays, weight): (RayColumns, [&[f64]; 3]),
        (samples, media): (&[u32], &Surroundings),
    ) {
        self.rays.pick(rays, numbers);
        let paths = &mut self.paths;
        paths.is_fresh = false;
        paths.weight.pick(weight, numbers);
        paths
            .sample
            .extend(numbers.iter().map(|number| samples[*number as usize]));
        paths.media.pick(media, numbers.iter().copied());
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

#[cfg(test)]
mod tests {
    use super::super::medium::{Media, Medium};
    use super::*;

    #[test]
    fn waves_take_what_each_ray_carries() {
        let water = Medium {
            part: 3,
            material: 0,
            ior: 1.33,
            absorb: DVec3::ZERO,
        };
        let wet = Media::EMPTY.entering(water).beyond;
        let mut media = Surroundings::empty(2);
        media.push(&wet);
        media.push(&Media::EMPTY);
        media.push(&wet);
        let column = [0.0, 1.0, 2.0, 3.0, 4.0];
        let columns = ([&column[..]; Rays::COLUMNS], [&column[..]; 3]);
        let samples = [10, 12, 13, 17, 18];
        let mut wave = Wave::new();
        // In a wave that held other rays.
        wave.take(&[2, 4], columns, (&samples, &media));
        wave = wave.cleared();
        for (numbers, media) in [
            (&[1, 2][..], &media),
            (&[], &media),
            (&[3], &Surroundings::empty(5)),
            (&[4], &media),
        ] {
            wave.take(numbers, columns, (&samples, media));
        }
        let paths = &wave.paths;
        for (i, (k, is_wet)) in [(1, false), (2, true), (3, false), (4, true)]
            .into_iter()
            .enumerate()
        {
            assert_eq!(wave.rays.at(i).t_max, column[k]);
            assert_eq!(paths.weight(i), DVec3::splat(column[k]));
            assert_eq!(paths.sample[i], samples[k]);
            let medium = paths.media.at(i).innermost();
            assert_eq!(medium, is_wet.then_some(&water));
        }
        assert_eq!((wave.rays.len(), paths.len()), (4, 4));
    }
}
