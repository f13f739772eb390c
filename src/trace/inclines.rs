//! Gradients at hits, in lanes.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::bundle::{Bundle, Choice, WIDTH};
use crate::field::{Closure, Task, Walked};
use crate::num::{Dual, F64x16, F64x32, Lanes, Vec3};

/// How many gradients dual numbers give at once.
const HALF: usize = F64x16::WIDTH;

/// Finds the gradients at the hits of up to 32 rays: the derivatives along the three axes.
pub(super) struct Gradient<'a> {
    pub bundle: &'a mut Bundle,
    pub source: &'a Derivatives<'a>,
    pub rays: &'a [u32],
}

/// Where derivatives come from.
pub(super) enum Derivatives<'a> {
    /// From dual numbers, for half as many places at once.
    Dual(&'a Closure<Dual<F64x16, 3>>),
    /// From a graph.
    Graph(&'a Walked<F64x32>),
}

impl Task for Gradient<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self {
            bundle,
            source,
            rays,
        } = self;
        let mut places = [[0.0; WIDTH]; 3];
        let choice = Choice::of(rays);
        let t = choice.picked(&bundle.t);
        for axis in 0..3 {
            let origin = choice.picked(&bundle.origin[axis]);
            let direction = choice.picked(&bundle.direction[axis]);
            for lane in 0..WIDTH {
                places[axis][lane] = origin[lane] + direction[lane] * t[lane];
            }
        }
        let mut gradient = [Lanes([0.0; WIDTH]); 3];
        match source {
            Derivatives::Graph(walk) => {
                let [x, y, z] = places.map(Lanes);
                walk(&Vec3::new(x, y, z), &mut gradient);
            }
            Derivatives::Dual(field) => {
                for first in (0..rays.len().min(WIDTH)).step_by(HALF) {
                    let mut some = [Lanes([0.0; HALF]); 3];
                    for axis in 0..3 {
                        some[axis]
                            .0
                            .copy_from_slice(&places[axis][first..first + HALF]);
                    }
                    let [x, y, z] = some;
                    let moving = Vec3::new(
                        Dual::variable(x, 0),
                        Dual::variable(y, 1),
                        Dual::variable(z, 2),
                    );
                    let partial = field(&moving).partial;
                    for axis in 0..3 {
                        gradient[axis].0[first..first + HALF].copy_from_slice(&partial[axis].0);
                    }
                }
            }
        }
        for axis in 0..3 {
            for lane in 0..rays.len() {
                bundle.gradient[axis][rays[lane] as usize] = gradient[axis].0[lane];
            }
        }
    }
}
