//! Mirrored repetition.

use super::repeat::{grid_shift, is_even, whole_counts};
use crate::catalogue::{Bounds, Class, Modifier, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// Repeats a shape on a grid around the origin, with every second copy mirrored; what sticks out of its cell is cut
    /// off, except at the ends of the grid.
    MirroredRepeat = "mirrored_repeat" {
        /// The size of the cells along x, y and z, in scene units; 0 for no repetition along that axis.
        spacing: [f64; 3], Vector3, Range::NOT_NEGATIVE;
        /// The number of copies along x, y and z; left out, the grid has no end.
        count: [f64; 3], Vector3, Range::COUNT, default [f64::INFINITY; 3];
    }
    source "hg_sdf (pModMirror); folds by the planes between the cells do not lengthen any segment"
    example "cone(0.2, 0.5).rotate(z: 50deg).mirrored_repeat(spacing: [0.6, 0, 0.6], count: [3, 1, 3])"
}

/// 1 for an even whole number, -1 for an odd one.
#[inline(always)]
fn parity(n: f64) -> f64 {
    if is_even(n) { 1.0 } else { -1.0 }
}

impl MirroredRepeat {
    /// Whether there is more than one copy along an axis.
    fn is_repeated(&self, axis: usize) -> bool {
        self.spacing[axis] > 0.0 && self.count[axis] > 1.0
    }

    /// Whether the first and the last copy are mirrored: -1, else 1.
    fn ends(&self, axis: usize) -> [f64; 2] {
        let count = self.count[axis];
        // The cell next above the middle is not mirrored.
        let (last, shift) = (0.5 * (count - 1.0), grid_shift(count));
        [parity(last + shift), parity(last - shift)]
    }

    /// The place in the cell of the child.
    #[inline(always)]
    fn folded<N: Number>(&self, axis: usize, x: N) -> N {
        if !self.is_repeated(axis) {
            return x;
        }
        let (spacing, count) = (N::splat(self.spacing[axis]), self.count[axis]);
        let (half, one) = (N::splat(0.5), N::splat(1.0));
        let place = x / spacing;
        let end = N::splat(0.5 * count);
        let inside = place.clamp(-end, end);
        let turn = ((inside + N::splat(0.5 - grid_shift(count))) * half).fract();
        let wave = half - (turn + turn - one).abs();
        if count.is_infinite() {
            return wave * spacing;
        }
        let [first, last] = self.ends(axis);
        let (first, last) = (N::splat(first), N::splat(last));
        let zero = N::splat(0.0);
        let beyond = (place - end).max(zero) * last + (place + end).min(zero) * first;
        (wave + beyond) * spacing
    }
}

impl Modifier for MirroredRepeat {
    const RULE: &'static str =
        "folds by the planes between the cells do not lengthen any segment (hg_sdf)";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        child(&Vec3::new(
            self.folded(0, p.x),
            self.folded(1, p.y),
            self.folded(2, p.z),
        ))
    }

    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds {
        let copy = child(level);
        let mut bounds = copy;
        if copy.is_empty() {
            return bounds;
        }
        for axis in (0..3).filter(|axis| self.is_repeated(*axis)) {
            let (spacing, count) = (self.spacing[axis], self.count[axis]);
            let last = 0.5 * (count - 1.0) * spacing;
            let [first_sign, last_sign] = self.ends(axis);
            // How far the copies at the ends reach outwards; all others end at the walls of theirs.
            let outwards = |sign: f64| {
                if sign > 0.0 {
                    copy.high[axis]
                } else {
                    -copy.low[axis]
                }
            };
            let wall = -0.5 * spacing;
            bounds.low[axis] = -last - outwards(-first_sign).max(wall);
            bounds.high[axis] = last + outwards(last_sign).max(wall);
        }
        bounds
    }

    fn domain(&self, region: Bounds) -> Bounds {
        let mut domain = region;
        for axis in (0..3).filter(|axis| self.is_repeated(*axis)) {
            let (half, end) = (
                0.5 * self.spacing[axis],
                0.5 * self.count[axis] * self.spacing[axis],
            );
            let beyond = (region.high[axis] - end)
                .max(-end - region.low[axis])
                .max(0.0);
            (domain.low[axis], domain.high[axis]) = (-half - beyond, half + beyond);
        }
        domain
    }

    fn lipschitz(&self, child: f64, _: Bounds) -> f64 {
        child
    }

    fn traits(&self, child: &Traits) -> Traits {
        if (0..3).all(|axis| !self.is_repeated(axis)) {
            return *child;
        }
        // An even number of cells is mirrored in its middle.
        let is_mirrored =
            |axis: usize| self.is_repeated(axis) && grid_shift(self.count[axis]) > 0.0;
        Traits {
            class: child.class.min(Class::Bound),
            is_convex: false,
            is_symmetric: std::array::from_fn(|i| child.is_symmetric[i] || is_mirrored(i)),
            ..*child
        }
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        whole_counts(&self.count)
    }
}
