//! Modifiers: transforms and warps of one child.

use super::{Bounds, Class, Declared, Traits};
use crate::num::{Number, Vec3};

/// The mathematics of a node with one child.
pub trait Modifier: Declared {
    /// The field at `p`, from values of the child at points that the modifier chooses.
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N;

    /// A box that holds every point where the field is at most `level >= 0`, from the same question about the child.
    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds;

    /// A box that holds every point at which the child is evaluated for points of `region`.
    fn domain(&self, region: Bounds) -> Bounds;

    /// A Lipschitz constant on `region`, given one of the child on [`Modifier::domain`] of it; infinite where there is
    /// none.
    fn lipschitz(&self, child: f64, region: Bounds) -> f64;

    /// Whether the constant depends on the region: there is none, or a larger one, on all of space.
    fn is_regional(&self) -> bool {
        false
    }

    /// The Lipschitz rule in words, with its source.
    const RULE: &'static str;

    /// What is known about the field, from what is known about the child.
    fn traits(&self, child: &Traits) -> Traits;

    /// The modifier as a similarity, where it is one.
    fn similarity(&self) -> Option<Similarity> {
        None
    }

    /// The modifier fitted to its child, of which `child` tells the sublevel boxes.
    ///
    /// # Errors
    /// A sentence that says why this child can't be modified so, and one that says what to do instead.
    fn fit(
        &mut self,
        _child: &Traits,
        _sublevel: &dyn Fn(f64) -> Bounds,
    ) -> Result<(), (String, String)> {
        Ok(())
    }

    /// What no range of a single parameter can say.
    ///
    /// # Errors
    /// The name of the parameter at fault and a sentence that says what is wrong with it.
    fn check(&self) -> Result<(), (&'static str, String)> {
        Ok(())
    }
}

/// What is left of what is known about a field when space is warped without any symmetry.
pub(super) fn warped(child: &Traits) -> Traits {
    Traits {
        class: Class::Lipschitz.min(child.class),
        is_convex: false,
        is_symmetric: [false; 3],
        ..*child
    }
}

/// That the child is a shape in space; `problem` says why a profile will not do.
pub(super) fn needs_space(child: &Traits, problem: &str) -> Result<(), (String, String)> {
    if child.is_planar {
        return Err((problem.into(), "extrude it first".into()));
    }
    Ok(())
}

/// The product of the matrix with these rows and `p`. Written out: a closure inside of `array::map` would be compiled
/// without the instructions of the caller.
#[inline(always)]
pub(super) fn rotated<N: Number>(rows: &[[f64; 3]; 3], p: &Vec3<N>) -> Vec3<N> {
    Vec3::new(
        Vec3::splat(rows[0]).dot(*p),
        Vec3::splat(rows[1]).dot(*p),
        Vec3::splat(rows[2]).dot(*p),
    )
}

/// A map that keeps angles: the child is evaluated at `rows * p + shift` and its value is multiplied by `scale`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Similarity {
    /// The rows of the matrix: a rotation or reflection, divided by `scale`.
    pub rows: [[f64; 3]; 3],
    /// What is added after the matrix.
    pub shift: [f64; 3],
    /// By how much lengths grow from the child to the outside; positive.
    pub scale: f64,
}

impl Similarity {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self {
        rows: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        shift: [0.0; 3],
        scale: 1.0,
    };

    /// The map that does `self` first and then `inner`, on the way from the outside to the child.
    pub fn then(&self, inner: &Self) -> Self {
        let column = |j: usize| [self.rows[0][j], self.rows[1][j], self.rows[2][j]];
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        Self {
            rows: inner
                .rows
                .map(|row| std::array::from_fn(|j| dot(row, column(j)))),
            shift: std::array::from_fn(|i| dot(inner.rows[i], self.shift) + inner.shift[i]),
            scale: self.scale * inner.scale,
        }
    }

    /// The point at which the child is evaluated.
    #[inline(always)]
    pub fn point<N: Number>(&self, p: &Vec3<N>) -> Vec3<N> {
        rotated(&self.rows, p) + Vec3::splat(self.shift)
    }

    /// The outside point that the child's point `q` comes from.
    pub fn outside(&self, q: [f64; 3]) -> [f64; 3] {
        let v: [f64; 3] = std::array::from_fn(|i| q[i] - self.shift[i]);
        let s = self.scale * self.scale;
        std::array::from_fn(|j| s * (0..3).map(|i| self.rows[i][j] * v[i]).sum::<f64>())
    }

    /// The outside direction that the child's direction `v` comes from, with its length scaled.
    pub fn outside_direction(&self, v: [f64; 3]) -> [f64; 3] {
        let s = self.scale * self.scale;
        std::array::from_fn(|j| s * (0..3).map(|i| self.rows[i][j] * v[i]).sum::<f64>())
    }

    /// As [`Similarity::point`]; a map that only moves adds and does no more.
    #[inline(always)]
    pub fn inside<N: Number>(&self, p: &Vec3<N>) -> Vec3<N> {
        if self.is_translation() {
            *p + Vec3::splat(self.shift)
        } else {
            self.point(p)
        }
    }

    /// The field outside, given the child's at [`Similarity::inside`].
    #[inline(always)]
    pub fn field<N: Number>(&self, value: N) -> N {
        if self.is_translation() {
            value
        } else {
            value * N::splat(self.scale)
        }
    }

    /// Whether the matrix is the identity: the map only moves.
    pub fn is_translation(&self) -> bool {
        self.rows == Self::IDENTITY.rows && self.scale == 1.0
    }
}

/// A [`Similarity`] whose numbers are kept as `N` keeps constants, for what is placed again and again.
pub struct Placing<N: Number> {
    rows: [[N::Constant; 3]; 3],
    shift: [N::Constant; 3],
    scale: N::Constant,
}

impl<N: Number> Placing<N> {
    /// The map, made ready.
    pub fn new(map: &Similarity) -> Self {
        Self {
            rows: map.rows.map(|row| row.map(N::constant)),
            shift: map.shift.map(N::constant),
            scale: N::constant(map.scale),
        }
    }

    /// As [`Similarity::point`].
    #[inline(always)]
    pub fn point(&self, p: &Vec3<N>) -> Vec3<N> {
        let turned = Vec3::new(
            Vec3::spread(self.rows[0]).dot(*p),
            Vec3::spread(self.rows[1]).dot(*p),
            Vec3::spread(self.rows[2]).dot(*p),
        );
        turned + Vec3::spread(self.shift)
    }

    /// As [`Placing::point`], of a map that only moves.
    #[inline(always)]
    pub fn moved(&self, p: &Vec3<N>) -> Vec3<N> {
        *p + Vec3::spread(self.shift)
    }

    /// The field outside, given the child's at [`Placing::point`].
    #[inline(always)]
    pub fn field(&self, value: N) -> N {
        value * N::spread(self.scale)
    }
}
