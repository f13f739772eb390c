//! Hits in the light of lamps, side by side.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::highlight::{GROUP, Group, groups};
use super::light::{Arrivals, Lamp};
use super::offset;
use super::phong::{Cosines, halfway};
use crate::field::Task;
use crate::num::{BATCH, Column, ROOM};
use crate::trace::vector::place;
use crate::trace::{Footprint, Outcomes, RayColumns, Rays};
use glam::DVec3;
use std::ops::Range;

/// Of so many neighbouring hits mostly all gain something, or none.
const SOME: usize = 16;

/// Up to [`BATCH`] hits as their viewer sees them, and what one lamp sends them. What was not hit is there too, with numbers
/// that mean nothing. Every column begins with a cache line.
#[repr(C, align(64))]
pub struct Lit {
    /// The unit normals on the side from which the rays came.
    normal: [Column; 3],
    /// Where rays start that leave on that side.
    start: [Column; 3],
    /// The strength of the lamp, 0 where it does not shine.
    pub strength: Column,
    /// The cosines that decide what is seen of it, as [`Cosines`].
    pub light: Column,
    pub mirror: Column,
    /// As [`halfway`]; 0 where no surface asks for it.
    pub halfway: Column,
    /// What the hits gain from the lamp, by channel, if nothing is in the way.
    pub gained: [Column; 3],
    /// Whether that is anything: 0 or 1, as wide as the other lanes.
    pub is_gained: [u64; ROOM],
    /// The way from the starts to the lamp: its unit vector, and where it ends.
    way: [Column; 3],
    end: Column,
    /// How wide pixels are at the hits, and by how much they grow.
    width: Column,
    spread: Column,
    /// Which of a wave's rays they are.
    pub numbers: Range<usize>,
}

impl Lit {
    /// No hits: large, so it lives in a box.
    pub fn new() -> Box<Self> {
        let column = [0.0; ROOM];
        Box::new(Self {
            numbers: 0..0,
            normal: [column; 3],
            start: [column; 3],
            strength: column,
            light: column,
            mirror: column,
            halfway: column,
            gained: [column; 3],
            is_gained: [0; ROOM],
            way: [column; 3],
            end: column,
            width: column,
            spread: column,
        })
    }

    /// The rays from these hits to the lamp.
    pub fn rays(&self) -> RayColumns<'_> {
        let ([a, b, c], [d, e, f]) = (&self.start, &self.way);
        let mut rays = [a, b, c, d, e, f, &self.end, &self.width, &self.spread].map(|c| &c[..]);
        for column in &mut rays {
            *column = &column[..self.numbers.len()];
        }
        rays
    }

    /// What they gain from it, by channel.
    pub fn gained(&self) -> [&[f64]; 3] {
        let [r, g, b] = &self.gained;
        [r, g, b].map(|channel| &channel[..self.numbers.len()])
    }

    /// The same, to be changed.
    pub fn gained_mut(&mut self) -> [&mut [f64]; 3] {
        let [r, g, b] = &mut self.gained;
        [r, g, b].map(|channel| &mut channel[..self.numbers.len()])
    }

    /// Lists which of these hits gain something, in order.
    pub fn list_gaining(&self, hits: &mut Vec<u32>) {
        hits.clear();
        let gained = &self.is_gained[..self.numbers.len()];
        for (first, some) in (0..).step_by(SOME).zip(gained.chunks(SOME)) {
            let count: u64 = some.iter().sum();
            if count == some.len() as u64 {
                hits.extend(first..first + some.len() as u32);
            } else if count > 0 {
                let gaining = (first..).zip(some).filter(|(_, gains)| **gains != 0);
                hits.extend(gaining.map(|(i, _)| i));
            }
        }
    }
}

/// Puts a group of numbers in their places, from number `first` on.
#[inline(always)]
pub fn put<const N: usize>(columns: [&mut Column; N], first: usize, groups: [&Group; N]) {
    for (column, group) in columns.into_iter().zip(groups) {
        column[first..first + GROUP].copy_from_slice(group);
    }
}

/// Takes hits as their viewer sees them.
pub struct Face<'a> {
    /// Where they go.
    pub lit: &'a mut Lit,
    /// The wave's rays.
    pub rays: &'a Rays,
    /// What they found.
    pub outcomes: &'a Outcomes,
    /// Which of them; at most [`BATCH`].
    pub numbers: Range<usize>,
}

impl<'a> Task for Face<'a> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let (lit, some) = (self.lit, self.numbers);
        let (rays, outcomes) = (self.rays, self.outcomes);
        let [_, _, _, a, b, c, _, width, spread] = rays.lanes();
        let [t, error, g, h, k, d, e, f] = outcomes.lanes();
        let columns = [a, b, c, d, e, f, g, h, k, t, error, width, spread];
        for first in (0..some.len()).step_by(GROUP) {
            let first = first.min(BATCH - GROUP);
            let [a, b, c, d, e, f, g, h, k, t, error, at_origin, grows] =
                groups(columns, some.start + first);
            let (mut normal, mut start) = ([[0.0; GROUP]; 3], [[0.0; GROUP]; 3]);
            let (mut width, mut spread) = ([0.0; GROUP], [0.0; GROUP]);
            for i in 0..GROUP {
                let facing = offset::facing(place(&[d, e, f], i), place(&[a, b, c], i));
                let begin = offset::start(place(&[g, h, k], i), t[i], error[i], facing);
                for axis in 0..3 {
                    normal[axis][i] = facing[axis];
                    start[axis][i] = begin[axis];
                }
                let footprint = Footprint {
                    at_origin: at_origin[i],
                    spread: grows[i],
                };
                width[i] = footprint.at(t[i]);
                spread[i] = footprint.spread;
            }
            put(lit.normal.each_mut(), first, normal.each_ref());
            put(lit.start.each_mut(), first, start.each_ref());
            let widths = [&mut lit.width, &mut lit.spread];
            put(widths, first, [&width, &spread]);
        }
        lit.numbers = some;
    }
}

/// Finds what a lamp sends to hits.
pub struct Shine<'a> {
    /// The hits.
    pub lit: &'a mut Lit,
    /// The lamp.
    pub lamp: &'a Lamp,
    /// The wave's rays.
    pub rays: &'a Rays,
    /// What they found.
    pub outcomes: &'a Outcomes,
    /// Whether the cosine half way between lamp and viewer is wanted; else it is 0.
    pub has_halfway: bool,
}

impl<'a> Task for Shine<'a> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let some = self.lit.numbers.clone();
        let lit = self.lit;
        let [_, _, a, b, c, ..] = self.outcomes.lanes();
        let [_, _, _, d, e, f, ..] = self.rays.lanes();
        for first in (0..some.len()).step_by(GROUP) {
            let first = first.min(BATCH - GROUP);
            let [a, b, c, d, e, f] = groups([a, b, c, d, e, f], some.start + first);
            let arrivals = self.lamp.shine([a, b, c]);
            shine(lit, &arrivals, [d, e, f], first);
            if self.has_halfway {
                let mut cosines = [0.0; GROUP];
                for i in 0..GROUP {
                    let normal = place(&lit.normal, first + i);
                    let (toward, view) = (place(&arrivals.toward, i), -place(&[d, e, f], i));
                    cosines[i] = halfway(normal, toward, view);
                }
                put([&mut lit.halfway], first, [&cosines]);
            }
            if let Some(position) = self.lamp.position() {
                aim(lit, position, first);
            } else {
                put(lit.way.each_mut(), first, arrivals.toward.each_ref());
                put([&mut lit.end], first, [&[f64::INFINITY; GROUP]]);
            }
        }
    }
}

/// Finds how a group of hits stands to a lamp, from number `first` on.
#[inline(always)]
fn shine(lit: &mut Lit, arrivals: &Arrivals, direction: [&Group; 3], first: usize) {
    let (mut light, mut mirror) = ([0.0; GROUP], [0.0; GROUP]);
    for i in 0..GROUP {
        let (normal, toward) = (place(&lit.normal, first + i), place(&arrivals.toward, i));
        let cosines = Cosines::new(normal, toward, -place(&direction, i));
        light[i] = cosines.light;
        mirror[i] = cosines.mirror;
    }
    let columns = [
        &mut lit.light,
        &mut lit.mirror,
        &mut lit.halfway,
        &mut lit.strength,
    ];
    let groups = [&light, &mirror, &[0.0; GROUP], &arrivals.strength];
    put(columns, first, groups);
}

/// Finds the ways from the starts of a group's shadow rays, from number `first` on, to a lamp.
#[inline(always)]
fn aim(lit: &mut Lit, lamp: DVec3, first: usize) {
    for i in first..first + GROUP {
        let way = lamp - place(&lit.start, i);
        let distance = way.length();
        let direction = way * (1.0 / distance);
        for axis in 0..3 {
            lit.way[axis][i] = direction[axis];
        }
        lit.end[i] = offset::before(distance);
    }
}
