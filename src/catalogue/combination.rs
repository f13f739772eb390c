//! Combinations: several fields as one, by a set operation with its blend, or by a blend alone.

use super::{AnyBlend, Blend, Bounds, Class, Manner, Traits, with_blend};
use crate::num::Number;

/// What is done with several shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// What is in any of the shapes.
    Union,
    /// What is in all of the shapes.
    Intersection,
    /// What is in the first shape and in none of the others.
    Difference,
    /// What the blend is alone, for blends that are operations of their own.
    Joint,
}

impl Operation {
    /// The set operations, by their names in scripts.
    pub const ALL: [(&'static str, Self); 3] = [
        ("union", Self::Union),
        ("intersection", Self::Intersection),
        ("difference", Self::Difference),
    ];

    /// The name in scripts; a joint has that of its blend.
    pub fn name(self) -> &'static str {
        match self {
            Self::Union => "union",
            Self::Intersection => "intersection",
            Self::Difference => "difference",
            Self::Joint => "joint",
        }
    }

    /// What it gives.
    pub fn summary(self) -> &'static str {
        match self {
            Self::Union => "What is in any of the shapes.",
            Self::Intersection => "What is in all of the shapes.",
            Self::Difference => "What is in the first shape and in none of the others.",
            Self::Joint => "What the blend makes of the shapes.",
        }
    }

    /// A line of script that shows it.
    pub fn example(self) -> &'static str {
        match self {
            Self::Union => "union(box([1.4, 0.6, 1.4]), sphere(0.6).translate([0, 0.5, 0]))",
            Self::Intersection => "intersection(box(1.4), sphere(0.9))",
            Self::Difference => "difference(box(1.4), sphere(0.9))",
            Self::Joint => "",
        }
    }

    /// The field of the operation on two fields, joined by `blend`.
    #[inline(always)]
    pub fn join<B: Blend, N: Number>(self, blend: &B, a: N, b: N) -> N {
        let value = self.joined(blend, a, b);
        if !N::HAS_ERRORS {
            return value;
        }
        // Errors of the fields change it by at most the sum of its partial derivatives times each. The formulas of most
        // blends use each field twice and would double them.
        let alone = self.joined(blend, a.computed_alone(), b.computed_alone());
        value.with_slope(alone, |[a, b]| blend.lipschitz(a, b), [a, b])
    }

    #[inline(always)]
    fn joined<B: Blend, N: Number>(self, blend: &B, a: N, b: N) -> N {
        match self {
            Self::Union | Self::Joint => united(blend, a, b),
            Self::Intersection => -united(blend, -a, -b),
            Self::Difference => -united(blend, -a, b),
        }
    }
}

/// The union, which a smooth minimum bends less than the formulas of most blends say, op by op.
#[inline(always)]
fn united<B: Blend, N: Number>(blend: &B, a: N, b: N) -> N {
    let value = blend.union(a, b);
    if N::HAS_BENDS {
        return value.with_curvature(blend.curvature(), [a, b]);
    }
    value
}

/// An operation with its blend: folds several fields from first to last.
#[derive(Clone, Debug, PartialEq)]
pub struct Combination {
    /// What is done.
    pub operation: Operation,
    /// How seams are joined, or the operation itself where it is [`Operation::Joint`].
    pub blend: AnyBlend,
}

impl Combination {
    /// The name of the operation in scripts.
    pub fn name(&self) -> &'static str {
        match self.operation {
            Operation::Joint => self.blend.name(),
            set => set.name(),
        }
    }

    /// Whether the operation fits the blend and the number `n` of shapes.
    ///
    /// # Errors
    /// A sentence that says what does not fit, and one that says what to do instead.
    pub fn check(&self, n: usize) -> Result<(), (String, String)> {
        let (name, blend) = (self.name(), self.blend.name());
        let is_joint = self.operation == Operation::Joint;
        match self.blend.manner() {
            Manner::Seam if is_joint => Err((
                format!("`{blend}` is a blend, not an operation"),
                format!("as in `union(a, b, blend: {blend}(...))`"),
            )),
            Manner::Pair | Manner::Several if !is_joint => Err((
                format!("`{blend}` is an operation of its own, not a blend of `{name}`"),
                format!("as in `{blend}(a, b, ...)`"),
            )),
            Manner::Pair if n != 2 => Err((
                format!("`{name}` takes two shapes, but here are {n}"),
                format!("as in `{name}(a, b, ...)`; unite several with `union(list)`"),
            )),
            _ if n == 0 => Err((format!("`{name}` needs at least one shape"), String::new())),
            _ => Ok(()),
        }
    }

    /// A Lipschitz constant of the combined field, from one of each child.
    pub fn lipschitz(&self, children: impl Iterator<Item = f64>) -> f64 {
        children
            .reduce(|a, b| self.blend.lipschitz(a, b))
            .unwrap_or(0.0)
    }

    /// Whether child number `i` only cuts or marks the first one: a new face shows its material if it has one, else that
    /// of the first.
    pub fn is_tool(&self, i: usize) -> bool {
        i > 0 && (self.operation == Operation::Difference || self.blend.is_tool())
    }

    /// A box that holds every point where the combined field is at most `level >= 0`, from the same question about
    /// each child, by number.
    pub fn sublevel(&self, n: usize, level: f64, child: &dyn Fn(usize, f64) -> Bounds) -> Bounds {
        match self.operation {
            Operation::Union | Operation::Joint => {
                with_blend!(&self.blend, blend => blend.sublevel(n, level, child))
            }
            // A seam lies below the minimum, so with the signs turned it lies above the maximum.
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
        let keeps_convex = match self.operation {
            Operation::Intersection => self.blend.is_hard(),
            // A mean of convex functions is convex.
            Operation::Joint => matches!(self.blend, AnyBlend::Morph(_)),
            Operation::Union | Operation::Difference => false,
        };
        Traits {
            class: children
                .iter()
                .map(|c| c.class)
                .min()
                .unwrap_or(Class::Bound)
                .min(Class::Bound),
            is_convex: keeps_convex && all(|c| c.is_convex),
            is_sheet: operands.iter().any(|c| c.is_sheet),
            is_symmetric: std::array::from_fn(|i| children.iter().all(|c| c.is_symmetric[i])),
            is_planar: all(|c| c.is_planar),
        }
    }
}
