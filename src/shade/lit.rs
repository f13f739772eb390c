//! Hits in the light of lamps, side by side.

use super::highlight::{GROUP, Group, groups};
use super::light::{Arrivals, Lamp};
use super::offset;
use super::phong::{Cosines, halfway};
use crate::field::Task;
use crate::trace::vector::place;
use crate::trace::{Footprint, Outcomes, Rays};
use glam::DVec3;
use std::ops::Range;

/// How many hits are lit at once.
pub const CHUNK: usize = 256;

type Column = [f64; CHUNK];

/// Up to [`CHUNK`] hits as their viewer sees them, and what one lamp sends them. What was not hit is there too, with numbers
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
    pub is_gained: [u64; CHUNK],
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
        let column = [0.0; CHUNK];
        Box::new(Self {
            numbers: 0..0,
            normal: [column; 3],
            start: [column; 3],
            strength: column,
            light: column,
            mirror: column,
            halfway: column,
            gained: [column; 3],
            is_gained: [0; CHUNK],
            way: [column; 3],
            end: column,
            width: column,
            spread: column,
        })
    }

    /// The columns of the rays from these hits to the lamp.
    pub fn shadow_columns(&self) -> [&Column; Rays::COLUMNS] {
        let ([a, b, c], [d, e, f]) = (&self.start, &self.way);
        [a, b, c, d, e, f, &self.end, &self.width, &self.spread]
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
    /// Which of them; at most [`CHUNK`].
    pub numbers: Range<usize>,
}

impl<'a> Task for Face<'a> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let (lit, some) = (self.lit, self.numbers);
        let slice = |column: &'a [f64]| &column[some.clone()];
        let (rays, outcomes) = (self.rays, self.outcomes);
        let direction = rays.direction().map(slice);
        let (normal, point) = (outcomes.normal().map(slice), outcomes.point().map(slice));
        let (t, error) = (slice(outcomes.t()), slice(outcomes.error()));
        let footprint = rays.footprint().map(slice);
        for first in (0..some.len()).step_by(GROUP) {
            let first = first.min(CHUNK - GROUP);
            let (direction, normal) = (groups(direction, first), groups(normal, first));
            let point = groups(point, first);
            let [t, error] = &groups([t, error], first);
            let [at_origin, spread] = &groups(footprint, first);
            for i in 0..GROUP {
                let facing = offset::facing(place(&normal, i), place(&direction, i));
                let start = offset::start(place(&point, i), t[i], error[i], facing);
                for axis in 0..3 {
                    lit.normal[axis][first + i] = facing[axis];
                    lit.start[axis][first + i] = start[axis];
                }
                let footprint = Footprint {
                    at_origin: at_origin[i],
                    spread: spread[i],
                };
                lit.width[first + i] = footprint.at(t[i]);
                lit.spread[first + i] = footprint.spread;
            }
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
        let slice = |column: &'a [f64]| &column[some.clone()];
        let point = self.outcomes.point().map(slice);
        let direction = self.rays.direction().map(slice);
        for first in (0..some.len()).step_by(GROUP) {
            let first = first.min(CHUNK - GROUP);
            let (point, direction) = (groups(point, first), groups(direction, first));
            let arrivals = self.lamp.shine(&point);
            shine(self.lit, &arrivals, &direction, first);
            if self.has_halfway {
                for i in 0..GROUP {
                    let normal = place(&self.lit.normal, first + i);
                    let (toward, view) = (place(&arrivals.toward, i), -place(&direction, i));
                    self.lit.halfway[first + i] = halfway(normal, toward, view);
                }
            }
            if let Some(position) = self.lamp.position() {
                aim(self.lit, position, first);
            }
        }
    }
}

/// Finds how a group of hits stands to a lamp, from number `first` on.
#[inline(always)]
fn shine(lit: &mut Lit, arrivals: &Arrivals, direction: &[Group; 3], first: usize) {
    for i in 0..GROUP {
        let (normal, toward) = (place(&lit.normal, first + i), place(&arrivals.toward, i));
        let cosines = Cosines::new(normal, toward, -place(direction, i));
        lit.light[first + i] = cosines.light;
        lit.mirror[first + i] = cosines.mirror;
        lit.halfway[first + i] = 0.0;
        lit.strength[first + i] = arrivals.strength[i];
        lit.end[first + i] = f64::INFINITY;
        for axis in 0..3 {
            lit.way[axis][first + i] = toward[axis];
        }
    }
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
