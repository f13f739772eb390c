//! What hits gain from a lamp if nothing is in the way, side by side.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::highlight::{GROUP, Group, groups, highlights};
use super::lighting::{LIGHTING, Lighting};
use super::lit::{Lit, put};
use super::phong::reflectance;
use crate::field::Task;
use crate::num::{BATCH, Columns};
use glam::DVec3;

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
        let Lighting {
            color: [a, b, c],
            diffuse,
            specular,
            shininess,
            blinn,
            ..
        } = Lighting::of(self.terms.lanes());
        let [d, e, f] = self.weight.lanes();
        let columns = [a, b, c, d, e, f, diffuse, specular, shininess, blinn];
        for first in (0..some.len()).step_by(GROUP) {
            let first = first.min(BATCH - GROUP);
            let terms = groups(columns, some.start + first);
            gain(lit, self.radiance, terms, first);
        }
    }
}

/// Finds what a group of hits gains, from number `first` on: of surfaces of these colours with these weights, shares of
/// diffuse light, highlights, exponents of these, and shares of Blinn's.
#[inline(always)]
fn gain(lit: &mut Lit, radiance: DVec3, terms: [&Group; 10], first: usize) {
    let [a, b, c, d, e, f, diffuse, specular, shininess, blinn] = terms;
    let (color, weight) = ([a, b, c], [d, e, f]);
    let (mut phong, mut half) = ([0.0; GROUP], [0.0; GROUP]);
    for i in 0..GROUP {
        // What sends no highlight has a cosine without one.
        let is_lit = (specular[i] != 0.0) & (lit.light[first + i] > 0.0);
        phong[i] = if is_lit { lit.mirror[first + i] } else { 0.0 };
        half[i] = if is_lit { lit.halfway[first + i] } else { 0.0 };
    }
    let highlight = highlights([&phong, &half], shininess, blinn);
    let (mut gained, mut is_gained) = ([[0.0; GROUP]; 3], [0; GROUP]);
    for i in 0..GROUP {
        let (strength, light) = (lit.strength[first + i], lit.light[first + i]);
        let shine = specular[i] * highlight[i];
        let (mut is_seen, mut is_sent) = (false, false);
        for k in 0..3 {
            let seen = reflectance(color[k][i], diffuse[i], light, shine);
            let sent = radiance[k] * strength;
            is_seen |= seen != 0.0;
            is_sent |= sent != 0.0;
            gained[k][i] = weight[k][i] * seen * sent;
        }
        let gains = (strength != 0.0) & (light > 0.0) & is_seen & is_sent;
        for k in 0..3 {
            gained[k][i] = if gains { gained[k][i] } else { 0.0 };
        }
        is_gained[i] = u64::from(gains);
    }
    put(lit.gained.each_mut(), first, gained.each_ref());
    lit.is_gained[first..first + GROUP].copy_from_slice(&is_gained);
}
