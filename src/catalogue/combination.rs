//! Combinations: union, intersection and difference of several fields, hard or blended.

use super::{AnyBlend, Blend, Bounds, Class, Traits};
use crate::num::Number;

/// A set operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// What is in any of the shapes.
    Union,
    /// What is in all of the shapes.
    Intersection,
    /// What is in the first shape and in none of the others.
    Difference,
}

impl Operation {
    /// All operations, by their names in scripts.
    pub const ALL: [(&'static str, Self); 3] = [
        ("union", Self::Union),
        ("intersection", Self::Intersection),
        ("difference", Self::Difference),
    ];

    /// The name in scripts.
    pub fn name(self) -> &'static str {
        match self {
            Self::Union => "union",
            Self::Intersection => "intersection",
            Self::Difference => "difference",
        }
    }

    /// What it gives.
    pub fn summary(self) -> &'static str {
        match self {
            Self::Union => "What is in any of the shapes.",
            Self::Intersection => "What is in all of the shapes.",
            Self::Difference => "What is in the first shape and in none of the others.",
        }
    }

    /// A line of script that shows it.
    pub fn example(self) -> &'static str {
        match self {
            Self::Union => "union(box([1.4, 0.6, 1.4]), sphere(0.6).translate([0, 0.5, 0]))",
            Self::Intersection => "intersection(box(1.4), sphere(0.9))",
            Self::Difference => "difference(box(1.4), sphere(0.9))",
        }
    }

    /// The field of the operation on two fields, joined by `blend`.
    #[inline(always)]
    pub fn join<B: Blend, N: Number>(self, blend: &B, a: N, b: N) -> N {
        match self {
            Self::Union => blend.union(a, b),
            Self::Intersection => -blend.union(-a, -b),
            Self::Difference => -blend.union(-a, b),
        }
    }
}

/// A set operation with its blend: folds several fields from first to last.
#[derive(Clone, Debug, PartialEq)]
pub struct Combination {
    /// What is done.
    pub operation: Operation,
    /// How seams are joined.
    pub blend: AnyBlend,
}

impl Combination {
    /// The Lipschitz rule in words, with its source.
    pub const RULE: &'static str = "the largest constant of the children: min, max and the smooth minimum have partial \
         derivatives that are not negative and sum to 1 (Hart 1996, section 3)";

    /// A box that holds every point where the combined field is at most `level >= 0`, from the same question about
    /// each child, by number.
    pub fn sublevel(&self, n: usize, level: f64, child: &dyn Fn(usize, f64) -> Bounds) -> Bounds {
        match self.operation {
            Operation::Union => {
                let level = level + self.blend.depth(n);
                (0..n).fold(Bounds::EMPTY, |b, i| b.hull(child(i, level)))
            }
            Operation::Intersection => {
                (0..n).fold(Bounds::EVERYWHERE, |b, i| b.intersect(child(i, level)))
            }
            Operation::Difference => child(0, level),
        }
    }

    /// What is known about the field, from what is known about the children.
    pub fn traits(&self, children: &[Traits]) -> Traits {
        let all = |f: fn(&Traits) -> bool| children.iter().all(f);
        let operands = match self.operation {
            Operation::Difference => &children[..1],
            _ => children,
        };
        Traits {
            class: children
                .iter()
                .map(|c| c.class)
                .min()
                .unwrap_or(Class::Bound)
                .min(Class::Bound),
            is_convex: self.operation == Operation::Intersection
                && self.blend.is_hard()
                && all(|c| c.is_convex),
            is_sheet: operands.iter().any(|c| c.is_sheet),
            is_symmetric: std::array::from_fn(|i| children.iter().all(|c| c.is_symmetric[i])),
            is_planar: all(|c| c.is_planar),
        }
    }
}
