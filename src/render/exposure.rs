//! What the samples of a block of pixels add up to: only what is asked for.

use super::Channel;
use crate::shade::Received;
use crate::trace::{Outcomes, Verdict};
use glam::DVec3;

/// The samples of a block so far.
pub(super) struct Exposure {
    /// Whether some ray of a pixel ended without an answer.
    is_unknown: Vec<bool>,
    sums: Vec<Sum>,
}

/// What one channel needs, for each pixel.
enum Sum {
    Beauty(Vec<DVec3>),
    Color(Vec<DVec3>),
    /// The distance of the nearest hit; infinite where there is none.
    Depth(Vec<f64>),
    /// The normal of the nearest hit, and its distance.
    Normal(Vec<(DVec3, f64)>),
    Steps(Vec<u64>),
    Evaluations(Vec<u64>),
    /// Whether there is a hit.
    Verdict(Vec<bool>),
    /// The part of the nearest hit, and its distance.
    Object(Vec<(u32, f64)>),
}

impl Exposure {
    /// Nothing yet of that many pixels, for these channels.
    pub fn new(channels: &[Channel], pixels: usize) -> Self {
        let far = f64::INFINITY;
        let sum = |channel: &Channel| match channel {
            Channel::Beauty => Sum::Beauty(vec![DVec3::ZERO; pixels]),
            Channel::Color => Sum::Color(vec![DVec3::ZERO; pixels]),
            Channel::Depth => Sum::Depth(vec![far; pixels]),
            Channel::Normal => Sum::Normal(vec![(DVec3::ZERO, far); pixels]),
            Channel::Steps => Sum::Steps(vec![0; pixels]),
            Channel::Evaluations => Sum::Evaluations(vec![0; pixels]),
            Channel::Verdict => Sum::Verdict(vec![false; pixels]),
            Channel::Object => Sum::Object(vec![(0, far); pixels]),
        };
        Self {
            is_unknown: vec![false; pixels],
            sums: channels.iter().map(sum).collect(),
        }
    }

    /// Adds what a sample of each pixel hit.
    pub fn add_hits(&mut self, outcomes: &Outcomes) {
        let (t, outward) = (outcomes.t(), outcomes.normal());
        let hit = |i: usize, before: f64| outcomes.verdict[i] == Verdict::Hit && t[i] < before;
        for (is_unknown, verdict) in self.is_unknown.iter_mut().zip(&outcomes.verdict) {
            *is_unknown |= *verdict == Verdict::Unknown;
        }
        for sum in &mut self.sums {
            match sum {
                Sum::Beauty(_) | Sum::Color(_) => {}
                Sum::Depth(depths) => each(depths, |i, depth| {
                    if hit(i, *depth) {
                        *depth = t[i];
                    }
                }),
                Sum::Normal(normals) => each(normals, |i, (normal, depth)| {
                    if hit(i, *depth) {
                        *depth = t[i];
                        *normal = DVec3::from_array([0, 1, 2].map(|axis: usize| outward[axis][i]));
                    }
                }),
                Sum::Steps(steps) => each(steps, |i, sum| *sum += u64::from(outcomes.steps[i])),
                Sum::Evaluations(evaluations) => {
                    each(evaluations, |i, sum| {
                        *sum += u64::from(outcomes.evaluations[i])
                    });
                }
                Sum::Verdict(hits) => each(hits, |i, is_hit| *is_hit |= hit(i, f64::INFINITY)),
                Sum::Object(objects) => each(objects, |i, (part, depth)| {
                    if hit(i, *depth) {
                        (*part, *depth) = (outcomes.part[i], t[i]);
                    }
                }),
            }
        }
    }

    /// Adds the flat colours of a sample of each pixel.
    pub fn add_colors(&mut self, colors: &[DVec3]) {
        for sum in &mut self.sums {
            if let Sum::Color(sums) = sum {
                each(sums, |i, sum| *sum += colors[i]);
            }
        }
    }

    /// Adds the light of a sample of each pixel.
    pub fn add_light(&mut self, light: &Received) {
        each(&mut self.is_unknown, |i, is_unknown| {
            *is_unknown |= light.unknown[i]
        });
        for sum in &mut self.sums {
            if let Sum::Beauty(sums) = sum {
                each(sums, |i, sum| *sum += light.radiance[i]);
            }
        }
    }

    /// How many pixels have a ray that ended without an answer.
    pub fn unknown(&self) -> usize {
        self.is_unknown
            .iter()
            .filter(|is_unknown| **is_unknown)
            .count()
    }

    /// The numbers of each channel, pixel by pixel, of that many samples.
    pub fn developed(&self, samples: u32) -> Vec<Vec<f32>> {
        let n = f64::from(samples);
        let is_hit = |depth: f64| depth < f64::INFINITY;
        let numbers = |sum: &Sum| match sum {
            Sum::Beauty(sums) | Sum::Color(sums) => triples(sums.iter().map(|sum| *sum / n)),
            Sum::Depth(depths) => depths.iter().map(|depth| *depth as f32).collect(),
            Sum::Normal(normals) => triples(normals.iter().map(|(normal, _)| *normal)),
            Sum::Steps(sums) | Sum::Evaluations(sums) => {
                sums.iter().map(|sum| (*sum as f64 / n) as f32).collect()
            }
            Sum::Verdict(hits) => {
                let verdict = |(is_unknown, is_hit): (&bool, &bool)| match (is_unknown, is_hit) {
                    (true, _) => 2.0,
                    (false, true) => 1.0,
                    (false, false) => 0.0,
                };
                self.is_unknown.iter().zip(hits).map(verdict).collect()
            }
            Sum::Object(objects) => {
                let number = |(part, depth): &(u32, f64)| {
                    if is_hit(*depth) { *part as f32 } else { -1.0 }
                };
                objects.iter().map(number).collect()
            }
        };
        self.sums.iter().map(numbers).collect()
    }
}

fn each<T>(sums: &mut [T], mut change: impl FnMut(usize, &mut T)) {
    sums.iter_mut()
        .enumerate()
        .for_each(|(i, sum)| change(i, sum));
}

fn triples(vectors: impl ExactSizeIterator<Item = DVec3>) -> Vec<f32> {
    let mut numbers = Vec::with_capacity(3 * vectors.len());
    for v in vectors {
        numbers.extend_from_slice(&[v.x as f32, v.y as f32, v.z as f32]);
    }
    numbers
}
