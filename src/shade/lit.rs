//! Hits in the light of lamps, side by side.

use super::light::Lamp;
use super::offset;
use super::phong::Cosines;
use crate::field::Task;
use crate::trace::{Footprint, Outcomes, Rays};
use glam::DVec3;
use std::ops::Range;

/// How many hits are lit at once.
pub const CHUNK: usize = 256;

type Column = [f64; CHUNK];

/// Up to [`CHUNK`] hits as their viewer sees them, and what one lamp sends them. What was not hit is there too, with numbers
/// that mean nothing.
pub struct Lit {
    /// Which of a wave's rays they are.
    pub numbers: Range<usize>,
    /// The unit normals on the side from which the rays came.
    normal: [Column; 3],
    /// Where rays start that leave on that side.
    start: [Column; 3],
    /// The strength of the lamp, 0 where it does not shine.
    pub strength: Column,
    /// The cosines that decide what is seen of it, as [`Cosines`].
    pub light: Column,
    pub mirror: Column,
    pub halfway: Column,
    /// The highlights, in [0, 1].
    pub highlight: Column,
    /// What the hits gain from the lamp, by channel, if nothing is in the way.
    pub gained: [Column; 3],
    /// Whether that is anything.
    pub is_gained: [u8; CHUNK],
    /// The way from the starts to the lamp: its unit vector, and where it ends.
    way: [Column; 3],
    end: Column,
    /// How wide pixels are at the hits, and by how much they grow.
    width: Column,
    spread: Column,
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
            highlight: column,
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

impl Task for Face<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let (lit, some) = (self.lit, &self.numbers);
        let n = some.len().min(CHUNK);
        let direction = places(self.rays.direction(), some);
        let (normal, point) = (
            places(self.outcomes.normal(), some),
            places(self.outcomes.point(), some),
        );
        let (t, error) = (
            &self.outcomes.t()[some.clone()],
            &self.outcomes.error()[some.clone()],
        );
        let [at_origin, spread] = self.rays.footprint();
        let (at_origin, spread) = (&at_origin[some.clone()], &spread[some.clone()]);
        for i in 0..n {
            let outward = place(normal, i);
            let is_outside = outward.dot(place(direction, i)) <= 0.0;
            let facing = if is_outside { outward } else { -outward };
            let start = offset::start(place(point, i), t[i], error[i], facing);
            for axis in 0..3 {
                lit.normal[axis][i] = facing[axis];
                lit.start[axis][i] = start[axis];
            }
            let footprint = Footprint {
                at_origin: at_origin[i],
                spread: spread[i],
            };
            lit.width[i] = footprint.at(t[i]);
            lit.spread[i] = footprint.spread;
        }
        lit.numbers = self.numbers;
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

impl Task for Shine<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let lit = self.lit;
        let some = lit.numbers.clone();
        let n = some.len().min(CHUNK);
        let view = places(self.rays.direction(), &some);
        self.lamp
            .shine(places(self.outcomes.point(), &some), |i, arrival| {
                let i = i.min(CHUNK - 1);
                lit.strength[i] = arrival.strength;
                for axis in 0..3 {
                    lit.way[axis][i] = arrival.toward[axis];
                }
            });
        for i in 0..n {
            let (normal, toward) = (placed(&lit.normal, i), placed(&lit.way, i));
            let cosines = Cosines::of_mirror(normal, toward, -place(view, i));
            lit.light[i] = cosines.light;
            lit.mirror[i] = cosines.mirror;
            lit.halfway[i] = cosines.halfway;
            lit.end[i] = f64::INFINITY;
        }
        if self.has_halfway {
            for i in 0..n {
                let (normal, toward) = (placed(&lit.normal, i), placed(&lit.way, i));
                lit.halfway[i] = Cosines::halfway(normal, toward, -place(view, i));
            }
        }
        if let Some(position) = self.lamp.position() {
            for i in 0..n {
                let way = position - placed(&lit.start, i);
                let distance = way.length();
                let direction = way * (1.0 / distance);
                for axis in 0..3 {
                    lit.way[axis][i] = direction[axis];
                }
                lit.end[i] = offset::before(distance);
            }
        }
    }
}

#[inline(always)]
fn places<'a>(columns: [&'a [f64]; 3], some: &Range<usize>) -> [&'a [f64]; 3] {
    let [x, y, z] = columns;
    [&x[some.clone()], &y[some.clone()], &z[some.clone()]]
}

#[inline(always)]
fn place(columns: [&[f64]; 3], i: usize) -> DVec3 {
    DVec3::new(columns[0][i], columns[1][i], columns[2][i])
}

#[inline(always)]
fn placed(columns: &[Column; 3], i: usize) -> DVec3 {
    DVec3::new(columns[0][i], columns[1][i], columns[2][i])
}
