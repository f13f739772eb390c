//! Warping by noise.

use crate::catalogue::modifier::{needs_space, warped};
use crate::catalogue::{Bounds, Modifier, Range, Traits, declaration::entry};
use crate::num::{Lattice, Number, Vec3};

entry! {
    /// Bends a shape by noise: every point is moved by up to about `amount`, neighbours within `scale` alike. While
    /// `amount` is below 0.2 of `scale`, nothing folds.
    Warp = "warp" {
        /// How far points move, along each axis, in scene units.
        amount: f64, Number, Range::NOT_NEGATIVE, default 0.1;
        /// The size of the cells of the noise, in scene units.
        scale: f64, Number, Range::POSITIVE, default 1.0;
    }
    derived {
        frequency: f64 = 1.0 / scale;
    }
    source "p + a n(p / s) with three noises: 1 + 4.7 a / s; own bound of the Jacobian of n, by branch and bound over \
            all gradients the corners of a cell can draw"
    example "sphere(0.9).warp(0.3, 0.8)"
}

/// Where the noise of each axis is taken: so far apart that the three have nothing to do with each other, and half a
/// cell apart along two axes each, so that no two are steep at the same place.
const PLACES: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [97.5, 41.5, 63.0], [31.0, 71.5, 103.5]];

/// The largest stretch of the three noises together, that is the norm of their Jacobian.
///
/// The largest slope of one noise in a direction, over all gradients that the corners of its cell can draw, is a norm of the
/// direction. So is the root of the sum of three squares, which is largest over a ball at a corner of any polytope around it;
/// for each corner, branch and bound over the place in the cell. With `PLACES` nothing is above 4.7, and climbing
/// finds 4.553. Three noises that are steep at the same place would give sqrt(3) 3.75 = 6.50.
const STEEPEST: f64 = 4.7;

impl Warp {
    /// How far a point can move along each axis.
    fn reach(&self) -> f64 {
        self.amount * Lattice::Noise.range()[1]
    }
}

impl Modifier for Warp {
    const RULE: &'static str = "times 1 + 4.7 amount / scale: the norm of the Jacobian of three independent noises that are not \
         steep at the same places";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        let (amount, q) = (N::splat(self.amount), *p * N::splat(self.frequency));
        let [a, b, c] = PLACES;
        let (a, b, c) = (q + Vec3::splat(a), q + Vec3::splat(b), q + Vec3::splat(c));
        let way = Vec3::new(
            N::lattice(Lattice::Noise, a.x, a.y, a.z),
            N::lattice(Lattice::Noise, b.x, b.y, b.z),
            N::lattice(Lattice::Noise, c.x, c.y, c.z),
        );
        child(&(*p + way * amount))
    }

    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds {
        self.domain(child(level))
    }

    fn domain(&self, region: Bounds) -> Bounds {
        if region.is_empty() {
            return region;
        }
        region.inflate(self.reach())
    }

    fn lipschitz(&self, child: f64, _: Bounds) -> f64 {
        child * (1.0 + STEEPEST * self.amount * self.frequency)
    }

    fn traits(&self, child: &Traits) -> Traits {
        if self.amount == 0.0 {
            return *child;
        }
        warped(child)
    }

    fn fit(&mut self, child: &Traits, _: &dyn Fn(f64) -> Bounds) -> Result<(), (String, String)> {
        needs_space(child, "a profile is not warped in space")
    }
}
