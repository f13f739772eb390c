//! The Menger sponge.
//!
//! Every round pierces all cubes that are left by three square bars. One round looks at the cube around the point alone:
//! the point is folded onto the centre of its third of the cell, axis by axis, which keeps distances or shortens them.

use crate::catalogue::{Bounds, Class, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// The Menger sponge: a cube pierced by square holes, again and again.
    Menger = "menger" {
        /// How often the cubes are pierced; 0 leaves the whole cube.
        iterations: f64, Count, Range::closed(0.0, 8.0), default 3.0;
        /// The full length of the sides, in scene units.
        size: f64, Number, Range::POSITIVE, default 1.4;
    }
    source "Menger 1926; the largest of the distance to the cube and the depths in the holes of each round; folds and maxima keep the constant 1"
    example "menger(3, 1.3).rotate(y: 30deg)"
}

/// A coordinate folded by the middle of its third and the next. No closure: in a loop that would be a function of its own, without
/// the instructions of the caller.
#[inline(always)]
fn folded<N: Number>(x: N, third: f64) -> N {
    x.min((x - N::splat(third)).abs())
}

impl Primitive for Menger {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let (zero, half) = (N::splat(0.0), N::splat(0.5 * self.size));
        let mut q = p.abs();
        let beyond = q - Vec3::new(half, half, half);
        let outside = beyond.max(Vec3::new(zero, zero, zero)).length();
        let mut distance = outside + beyond.max_component().min(zero);
        let mut third = self.size;
        for _ in 0..self.iterations as u32 {
            third /= 3.0;
            // The point is in a bar if two of its coordinates are: the middle one tells how deep.
            let middle = q.x.min(q.y).max(q.x.max(q.y).min(q.z));
            distance = distance.max(N::splat(0.5 * third) - middle);
            q = Vec3::new(folded(q.x, third), folded(q.y, third), folded(q.z, third));
        }
        distance
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::centred([0.5 * self.size; 3]).inflate(level)
    }

    fn traits(&self) -> Traits {
        if self.iterations < 1.0 {
            return Traits::CONVEX;
        }
        Traits {
            class: Class::Bound,
            is_convex: false,
            ..Traits::CONVEX
        }
    }
}
