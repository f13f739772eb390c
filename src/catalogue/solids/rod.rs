//! The rod.

use crate::catalogue::space_geometry::{cross, middle, minus, norm, unit};
use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A round bar from one point to another, a cylinder where it is needed: flat ends, edges rounded if wanted.
    Rod = "rod" {
        /// The middle of one end, in scene units.
        a: [f64; 3], Vector3, Range::ANY, default [-0.5, -0.5, 0.0];
        /// The middle of the other end, somewhere else.
        b: [f64; 3], Vector3, Range::ANY, default [0.5, 0.5, 0.0];
        /// The radius, in scene units.
        radius: f64, Number, Range::POSITIVE, default 0.2;
        /// The radius of the edges, at most the radius and half the length.
        round: f64, Number, Range::NOT_NEGATIVE, default 0.0;
    }
    derived {
        frame: [[f64; 3]; 3] = frame(unit(minus(b, a)));
        length: f64 = norm(minus(b, a));
    }
    source "Quilez, distance functions (cylinder between two points), rounded; a distance, so its constant is 1"
    example "rod([-0.6, -0.5, 0.3], [0.6, 0.5, -0.3], 0.25)"
}

/// Three orthogonal unit vectors, the first of which is given.
fn frame(along: [f64; 3]) -> [[f64; 3]; 3] {
    let least = (0..3).fold(0, |i, j| {
        if along[j].abs() < along[i].abs() {
            j
        } else {
            i
        }
    });
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let across = unit(cross(axis, along));
    [along, across, cross(along, across)]
}

impl Primitive for Rod {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let zero = N::splat(0.0);
        let q = *p - Vec3::splat(middle(self.a, self.b));
        let [along, u, v] = self.frame;
        let across = Vec3::splat(u).dot(q).hypot(Vec3::splat(v).dot(q));
        let side = across - N::splat(self.radius - self.round);
        let cap = Vec3::splat(along).dot(q).abs() - N::splat(0.5 * self.length - self.round);
        side.max(zero).hypot(cap.max(zero)) + side.max(cap).min(zero) - N::splat(self.round)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        // Along an axis, as far as the middle line and the disc at its end reach.
        let half = self.frame[0].map(|c| {
            let line = c.abs() * (0.5 * self.length - self.round);
            line + (1.0 - c * c).max(0.0).sqrt() * (self.radius - self.round) + self.round
        });
        Bounds::centred(half)
            .translate(middle(self.a, self.b))
            .inflate(level)
    }

    fn traits(&self) -> Traits {
        let same = |i: usize| self.a[i] == 0.0 && self.b[i] == 0.0;
        let swapped = |i: usize| self.a[i] == -self.b[i];
        let [x, y, z] = [0, 1, 2].map(|i| self.a[i] == self.b[i]);
        // Ends that a mirror leaves in place, or exchanges.
        Traits {
            is_symmetric: [
                same(0) || (swapped(0) && y && z),
                same(1) || (swapped(1) && x && z),
                same(2) || (swapped(2) && x && y),
            ],
            ..Traits::CONVEX
        }
    }

    fn check(&self) -> Result<(), (&'static str, String)> {
        if self.length == 0.0 {
            return Err(("b", "must differ from `a`".into()));
        }
        let most = self.radius.min(0.5 * self.length);
        if self.round <= most {
            return Ok(());
        }
        let which = if most < self.radius {
            "half the length"
        } else {
            "the radius"
        };
        Err(("round", format!("must be at most {most}, {which}")))
    }
}
