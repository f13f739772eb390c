//! What hits gain from a lamp if nothing is in the way, side by side.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::highlight::{GROUP, groups, highlights};
use super::lighting::{LIGHTING, Lighting};
use super::lit::{CHUNK, Lit};
use super::medium::Surroundings;
use super::phong::reflectance;
use super::wave::Paths;
use crate::field::Task;
use crate::num::Columns;
use crate::trace::{Occlusions, Rays};
use glam::DVec3;

/// What hits gain from one lamp, and the rays that find out whether they do.
#[derive(Clone, Debug, Default)]
pub struct Gains {
    /// The rays from the hits towards the lamp; each ends before it.
    pub rays: Rays,
    /// The media around their starts, where shadows are tinted.
    pub media: Surroundings,
    /// Which camera rays gain.
    pub samples: Vec<u32>,
    /// By how much, by channel.
    pub radiance: Columns<3>,
    /// What is in the way of the rays, once that was asked.
    pub occlusions: Occlusions,
}

impl Gains {
    /// Forgets all of them.
    pub fn clear(&mut self) {
        self.rays.clear();
        self.media.clear();
        self.samples.clear();
        self.radiance.resize(0);
    }

    /// Adds the hits of a chunk that gain something, on these paths; with their media only if these count.
    pub fn take(&mut self, lit: &Lit, paths: &Paths, with_media: bool) {
        let count = lit.numbers.len();
        let is_gained = &lit.is_gained[..count];
        let columns = lit.shadow_columns().map(|column| &column[..count]);
        let gained = lit.gained.each_ref().map(|column| &column[..count]);
        if is_gained.iter().all(|gains| *gains != 0) {
            self.rays.append(columns);
            self.radiance.append(gained);
            self.samples
                .extend_from_slice(&paths.sample[lit.numbers.clone()]);
        } else {
            let hits = is_gained.iter().enumerate();
            let hits: Vec<u32> = hits
                .filter_map(|(i, gains)| (*gains != 0).then_some(i as u32))
                .collect();
            self.rays.pick(columns, &hits);
            self.radiance.pick(gained, &hits);
            let sample = |hit: &u32| paths.sample[lit.numbers.start + *hit as usize];
            self.samples.extend(hits.iter().map(sample));
        }
        if !with_media {
            return;
        }
        if paths.media.are_empty() && self.media.are_empty() {
            self.media = Surroundings::empty(self.samples.len());
            return;
        }
        for (number, gains) in lit.numbers.clone().zip(is_gained) {
            if *gains != 0 {
                self.media.push(paths.media.at(number));
            }
        }
    }
}

/// Finds what hits show of a lamp that shines on them.
pub struct Gain<'a> {
    /// The hits, and what the lamp sends them.
    pub lit: &'a mut Lit,
    /// What the lamp sends in full.
    pub radiance: DVec3,
    /// The terms of the surfaces of all rays of the wave.
    pub terms: &'a Columns<LIGHTING>,
    /// Their weights.
    pub weight: &'a Columns<3>,
}

impl Task for Gain<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let lit = self.lit;
        let some = lit.numbers.clone();
        let terms = self.terms.columns().map(|column| &column[some.clone()]);
        let terms = Lighting::of(terms);
        let weight = self.weight.columns().map(|column| &column[some.clone()]);
        for first in (0..some.len()).step_by(GROUP) {
            let first = first.min(CHUNK - GROUP);
            gain(lit, self.radiance, &terms, weight, first);
        }
    }
}

/// Finds what a group of hits gains, from number `first` on.
#[inline(always)]
fn gain(lit: &mut Lit, radiance: DVec3, terms: &Lighting, weight: [&[f64]; 3], first: usize) {
    let weight = groups(weight, first);
    let color = groups(terms.color, first);
    let shares = [terms.diffuse, terms.specular, terms.shininess, terms.blinn];
    let [diffuse, specular, shininess, blinn] = &groups(shares, first);
    let (mut phong, mut half) = ([0.0; GROUP], [0.0; GROUP]);
    for i in 0..GROUP {
        // What sends no highlight has a cosine without one.
        let is_lit = (specular[i] != 0.0) & (lit.light[first + i] > 0.0);
        phong[i] = if is_lit { lit.mirror[first + i] } else { 0.0 };
        half[i] = if is_lit { lit.halfway[first + i] } else { 0.0 };
    }
    let highlight = highlights([&phong, &half], shininess, blinn);
    for i in 0..GROUP {
        let (strength, light) = (lit.strength[first + i], lit.light[first + i]);
        let shine = specular[i] * highlight[i];
        let (mut is_seen, mut is_sent) = (false, false);
        for k in 0..3 {
            let seen = reflectance(color[k][i], diffuse[i], light, shine);
            let sent = radiance[k] * strength;
            is_seen |= seen != 0.0;
            is_sent |= sent != 0.0;
            lit.gained[k][first + i] = weight[k][i] * seen * sent;
        }
        let gains = (strength != 0.0) & (light > 0.0) & is_seen & is_sent;
        lit.is_gained[first + i] = u64::from(gains);
    }
}
