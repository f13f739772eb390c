//! What the samples of a block of pixels add up to: only what is asked for.

use super::Channel;
use super::area::Area;
use super::block::Block;
use super::film::Patch;
use crate::num::Columns;
use crate::shade::Received;
use crate::trace::{Outcomes, Verdict, count};
use glam::DVec3;

/// The samples of a block so far.
pub(super) struct Exposure {
    /// Whether some ray of a pixel ended without an answer.
    is_unknown: Vec<bool>,
    sums: Vec<Sum>,
    /// What is recorded of a channel: memory that is used again.
    sheet: [Vec<f32>; 3],
}

/// What one channel needs, for each pixel.
enum Sum {
    Beauty(Columns<3>),
    Color(Columns<3>),
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
    /// Nothing yet of no pixels, for these channels.
    pub fn new(channels: &[Channel]) -> Self {
        let sum = |channel: &Channel| match channel {
            Channel::Beauty => Sum::Beauty(Columns::default()),
            Channel::Color => Sum::Color(Columns::default()),
            Channel::Depth => Sum::Depth(Vec::new()),
            Channel::Normal => Sum::Normal(Vec::new()),
            Channel::Steps => Sum::Steps(Vec::new()),
            Channel::Evaluations => Sum::Evaluations(Vec::new()),
            Channel::Verdict => Sum::Verdict(Vec::new()),
            Channel::Object => Sum::Object(Vec::new()),
        };
        Self {
            is_unknown: Vec::new(),
            sums: channels.iter().map(sum).collect(),
            sheet: Default::default(),
        }
    }

    /// So many samples of one pixel whose rays meet nothing and show this colour.
    pub fn even(channels: &[Channel], samples: u32, color: DVec3) -> Self {
        let mut light = Received::default();
        light.radiance.push(color.to_array());
        light.unknown.push(false);
        let mut exposure = Self::new(channels);
        exposure.reset(1);
        for _ in 0..samples {
            exposure.add_colors(&light.radiance);
            exposure.add_light(&light);
        }
        exposure
    }

    /// Forgets all of it, for that many pixels.
    pub fn reset(&mut self, pixels: usize) {
        let far = f64::INFINITY;
        begin(&mut self.is_unknown, pixels, false);
        for sum in &mut self.sums {
            match sum {
                // The first sample makes room.
                Sum::Beauty(sums) | Sum::Color(sums) => sums.resize(0),
                Sum::Depth(depths) => begin(depths, pixels, far),
                Sum::Normal(normals) => begin(normals, pixels, (DVec3::ZERO, far)),
                Sum::Steps(sums) | Sum::Evaluations(sums) => begin(sums, pixels, 0),
                Sum::Verdict(hits) => begin(hits, pixels, false),
                Sum::Object(objects) => begin(objects, pixels, (0, far)),
            }
        }
    }

    /// Adds what a sample of each pixel hit.
    pub fn add_hits(&mut self, outcomes: &Outcomes) {
        let (t, outward) = (outcomes.t(), outcomes.normal());
        let hit = |i: usize, before: f64| outcomes.verdict[i] == Verdict::Hit && t[i] < before;
        if count(&outcomes.verdict, Verdict::Unknown) > 0 {
            for (is_unknown, verdict) in self.is_unknown.iter_mut().zip(&outcomes.verdict) {
                *is_unknown |= *verdict == Verdict::Unknown;
            }
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
    pub fn add_colors(&mut self, colors: &Columns<3>) {
        for sum in &mut self.sums {
            if let Sum::Color(sums) = sum {
                add(sums, colors);
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
                add(sums, &light.radiance);
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

    /// Records what that many samples of the pixels of a block add up to.
    pub fn develop(&mut self, samples: u32, block: &Block, patch: &mut Patch) {
        self.each_channel(samples, |k, numbers| match numbers {
            Numbers::One(numbers) => patch.record(k, block, numbers),
            Numbers::Three(numbers) => patch.record(k, block, numbers),
        });
    }

    /// Records what that many samples of one pixel add up to as that of all pixels of an area.
    pub fn develop_all(&mut self, samples: u32, area: &Area, patch: &mut Patch) {
        self.each_channel(samples, |k, numbers| match numbers {
            Numbers::One(numbers) => patch.fill(k, area, numbers.map(|column| column[0])),
            Numbers::Three(numbers) => patch.fill(k, area, numbers.map(|column| column[0])),
        });
    }

    /// Calls `record` with the number of each channel, and its numbers of all pixels.
    fn each_channel(&mut self, samples: u32, mut record: impl FnMut(usize, Numbers)) {
        let n = f64::from(samples);
        let mean = |sum: f64| (if samples == 1 { sum } else { sum / n }) as f32;
        let unknown = &self.is_unknown;
        let [x, y, z] = &mut self.sheet;
        for (k, sum) in self.sums.iter().enumerate() {
            let mut is_one = true;
            match sum {
                Sum::Beauty(sums) | Sum::Color(sums) => {
                    for (sheet, column) in [&mut *x, y, z].into_iter().zip(sums.columns()) {
                        put(sheet, column.iter().map(|sum| mean(*sum)));
                    }
                    is_one = false;
                }
                Sum::Normal(normals) => {
                    for (axis, sheet) in [&mut *x, y, z].into_iter().enumerate() {
                        put(sheet, normals.iter().map(|(normal, _)| normal[axis] as f32));
                    }
                    is_one = false;
                }
                Sum::Depth(depths) => put(x, depths.iter().map(|depth| *depth as f32)),
                Sum::Steps(sums) | Sum::Evaluations(sums) => {
                    put(x, sums.iter().map(|sum| mean(*sum as f64)));
                }
                Sum::Verdict(hits) => put(x, unknown.iter().zip(hits).map(as_verdict)),
                Sum::Object(objects) => put(x, objects.iter().map(as_object)),
            }
            let numbers = if is_one {
                Numbers::One([x])
            } else {
                Numbers::Three([x, y, z])
            };
            record(k, numbers);
        }
    }
}

/// The numbers of a channel, column by column.
enum Numbers<'a> {
    One([&'a [f32]; 1]),
    Three([&'a [f32]; 3]),
}

fn as_verdict((is_unknown, is_hit): (&bool, &bool)) -> f32 {
    match (is_unknown, is_hit) {
        (true, _) => 2.0,
        (false, true) => 1.0,
        (false, false) => 0.0,
    }
}

fn as_object((part, depth): &(u32, f64)) -> f32 {
    let is_hit = *depth < f64::INFINITY;
    if is_hit { *part as f32 } else { -1.0 }
}

/// Replaces numbers by others.
fn put(sheet: &mut Vec<f32>, numbers: impl Iterator<Item = f32>) {
    sheet.clear();
    sheet.extend(numbers);
}

/// Makes it so many of the same.
fn begin<T: Copy>(sums: &mut Vec<T>, pixels: usize, first: T) {
    sums.clear();
    sums.resize(pixels, first);
}

fn each<T>(sums: &mut [T], mut change: impl FnMut(usize, &mut T)) {
    sums.iter_mut()
        .enumerate()
        .for_each(|(i, sum)| change(i, sum));
}

/// Adds columns to others, of which there may be none yet.
fn add(sums: &mut Columns<3>, more: &Columns<3>) {
    if sums.is_empty() {
        return sums.append(more.columns());
    }
    for (sum, more) in sums.columns_mut().into_iter().zip(more.columns()) {
        sum.iter_mut().zip(more).for_each(|(sum, x)| *sum += x);
    }
}
