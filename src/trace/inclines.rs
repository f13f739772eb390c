//! Gradients at hits, in lanes.

#![allow(
    clippy::needless_range_loop,
    reason = "lanes run through many arrays side by side"
)]

use super::bundle::{Bundle, Choice, WIDTH};
use crate::field::{Closure, Task, Walked};
use crate::num::{Dual, F64x32, Lanes, Vec3};

/// Finds the gradients at the hits of up to 32 rays: the derivatives along the three axes.
pub(super) struct Gradient<'a> {
    pub bundle: &'a mut Bundle,
    pub source: &'a Derivatives<'a>,
    pub rays: &'a [u32],
}

/// Where derivatives come from.
pub(super) enum Derivatives<'a> {
    /// From dual numbers, along one axis at a time.
    Along(&'a Closure<Dual<F64x32, 1>>),
    /// From a graph, along all three.
    All(&'a Walked<F64x32>),
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
            Derivatives::All(walk) => {
                let [x, y, z] = places.map(Lanes);
                walk(&Vec3::new(x, y, z), &mut gradient);
            }
            Derivatives::Along(slope) => {
                for axis in 0..3 {
                    let moving = |k: usize| {
                        let rate = if k == axis { 1.0 } else { 0.0 };
                        Dual::new(Lanes(places[k]), [Lanes([rate; WIDTH])])
                    };
                    gradient[axis] = slope(&Vec3::new(moving(0), moving(1), moving(2))).partial[0];
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
