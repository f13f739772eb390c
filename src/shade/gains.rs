//! What hits gain from a lamp if nothing is in the way, side by side.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::highlight::{GROUP, Group, highlights};
use super::lit::{CHUNK, Lit};
use super::medium::Media;
use super::palette::{LIGHTING, Lighting};
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
    /// The media around their starts, one for each where shadows are tinted, else none.
    pub media: Vec<Media>,
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
        if with_media {
            for (number, gains) in lit.numbers.clone().zip(is_gained) {
                if *gains != 0 {
                    self.media.push(paths.media(number).clone());
                }
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
        let n = some.len().min(CHUNK);
        let terms = self
            .terms
            .columns()
            .map(|column| &column[some.clone()][..n]);
        let terms = Lighting::of(terms);
        let weight = self
            .weight
            .columns()
            .map(|column| &column[some.clone()][..n]);
        for first in (0..n).step_by(GROUP) {
            shine(lit, &terms, first.min(CHUNK - GROUP));
        }
        let Lighting {
            color,
            diffuse,
            specular,
            ..
        } = terms;
        for i in 0..n {
            let (strength, light) = (lit.strength[i], lit.light[i]);
            let (mut is_seen, mut is_sent) = (false, false);
            for k in 0..3 {
                let seen = reflectance(
                    color[k][i],
                    diffuse[i],
                    light,
                    specular[i] * lit.highlight[i],
                );
                let sent = self.radiance[k] * strength;
                is_seen |= seen != 0.0;
                is_sent |= sent != 0.0;
                lit.gained[k][i] = weight[k][i] * seen * sent;
            }
            lit.is_gained[i] = u8::from((strength != 0.0) & (light > 0.0) & is_seen & is_sent);
        }
    }
}

/// Finds the highlights of a group of hits, from number `first` on.
#[inline(always)]
fn shine(lit: &mut Lit, terms: &Lighting, first: usize) {
    let group = |column: &[f64]| {
        let mut group: Group = [0.0; GROUP];
        let column = &column[first..];
        let count = column.len().min(GROUP);
        group[..count].copy_from_slice(&column[..count]);
        group
    };
    let specular = group(terms.specular);
    let (mirror, halfway) = (
        &lit.mirror[first..][..GROUP],
        &lit.halfway[first..][..GROUP],
    );
    let light = &lit.light[first..][..GROUP];
    let (mut phong, mut blinn): (Group, Group) = ([0.0; GROUP], [0.0; GROUP]);
    for i in 0..GROUP {
        // What sends no highlight has a cosine without one.
        let is_lit = (specular[i] != 0.0) & (light[i] > 0.0);
        phong[i] = if is_lit { mirror[i] } else { 0.0 };
        blinn[i] = if is_lit { halfway[i] } else { 0.0 };
    }
    let found = highlights(
        [&phong, &blinn],
        &group(terms.shininess),
        &group(terms.blinn),
    );
    lit.highlight[first..][..GROUP].copy_from_slice(&found);
}
