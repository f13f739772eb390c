//! The superellipsoid.

use crate::catalogue::{Bounds, Class, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// An ellipsoid with sharper or rounder edges: from nearly a box (both exponents small) over a cylinder (the first small)
    /// and an ellipsoid (both 1) to an octahedron (both 2).
    Superellipsoid = "superellipsoid" {
        /// The semi-axes along x, y and z, in scene units.
        radii: [f64; 3], Vector3, Range::POSITIVE, default [0.9, 0.7, 0.9];
        /// The exponent of sections through the y axis: below 1 squarer, 1 round, 2 straight to the tip.
        e1: f64, Number, Range::closed(0.05, 2.0), default 0.4;
        /// The exponent of sections across the y axis: below 1 squarer, 1 round, 2 a diamond.
        e2: f64, Number, Range::closed(0.05, 2.0), default 0.4;
    }
    derived {
        inverse: [f64; 3] = radii.map(|r| 1.0 / r);
        inradius: f64 = 1.0 / steepest(steepest(1.0 / radii[0], 1.0 / radii[2], e2), 1.0 / radii[1], e1);
    }
    source "Barr 1981; the gauge of a convex body, less 1, times the body's inradius, by Hoelder's inequality"
    example "superellipsoid([0.9, 0.7, 0.9], 0.4, 0.4)"
}

/// The largest value of the norm `(a x, b y)` with exponent `2 / e` on the unit circle, for positive a and b. For e <= 1
/// the norm is at most the Euclidean; else by Hoelder's inequality, in which some x and y attain equality.
fn steepest(a: f64, b: f64, e: f64) -> f64 {
    let (most, least) = (a.max(b), a.min(b));
    if e <= 1.0 {
        return most;
    }
    let r = 2.0 / (e - 1.0);
    most * (1.0 + (least / most).powf(r)).powf(1.0 / r)
}

/// The norm of `(a, b)` with exponent `2 / e`, for `a, b >= 0`: the larger times a power of the ratio, which does not
/// overflow.
#[inline(always)]
fn norm<N: Number>(a: N, b: N, e: f64) -> N {
    if e == 1.0 {
        return a.hypot(b);
    }
    // Below this the smaller does not change the sum; its power has no slope at 0.
    let tiny = N::splat(1e-30);
    let one = N::splat(1.0);
    // The lesser, with the other's derivative where both are equal.
    let (most, least) = (a.max(b), a - (a - b).max(N::splat(0.0)));
    let ratio = least.direction_cosine(most).clamp(tiny, one);
    let sum = one + (ratio.ln() * N::splat(2.0 / e)).exp();
    most * (sum.ln() * N::splat(0.5 * e)).exp()
}

impl Primitive for Superellipsoid {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let q = p.times(Vec3::splat(self.inverse)).abs();
        let gauge = norm(norm(q.x, q.z, self.e2), q.y, self.e1);
        (gauge - N::splat(1.0)) * N::splat(self.inradius)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let gauge = 1.0 + level / self.inradius;
        Bounds::centred(self.radii.map(|r| r * gauge))
    }

    fn traits(&self) -> Traits {
        let is_ball = self.e1 == 1.0 && self.e2 == 1.0 && self.radii == [self.radii[0]; 3];
        Traits {
            class: if is_ball { Class::Exact } else { Class::Bound },
            ..Traits::CONVEX
        }
    }
}
