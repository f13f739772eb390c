//! Bend.

use super::sweep::{corners, largest_stretch};
use crate::catalogue::{Bounds, Class, Modifier, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// Bends a shape along the x axis: turns it about the z axis, the more the further out, so that both ends go down
    /// for a positive rate.
    Bend = "bend" {
        /// The angle for each scene unit along x.
        rate: f64, Angle, Range::ANY, default std::f64::consts::FRAC_PI_4;
    }
    source "Quilez, distance functions (cheap bend); the constant is multiplied by the norm of the Jacobian, at most \
        1 + |rate| r with r the distance from the z axis"
    example "box([2, 0.3, 0.6]).bend(rate: 40deg)"
}

/// Into how many slabs across x a box is cut to find out where it goes.
const SLABS: u32 = 256;

impl Bend {
    /// The matrix with rows (a, b) and (0, 1), transposed, is the Jacobian at (x, y) but for a rotation.
    fn stretch(&self, x: f64, y: f64) -> f64 {
        largest_stretch(1.0 - self.rate * y, self.rate * x)
    }

    /// A box around all that the part of `bounds` between two places along x becomes when it is turned by the middle
    /// of `turns`, with room for all angles between.
    fn turned(bounds: &Bounds, turns: [f64; 2], strip: [f64; 2], radius: f64) -> Bounds {
        let (s, c) = libm::sincos(0.5 * (turns[0] + turns[1]));
        let room = radius * 0.5 * (turns[1] - turns[0]).abs();
        let [left, right] = [strip[0] - room, strip[1] + room];
        let corners = corners(bounds, 0, 1).map(|(x, y)| (x * c - y * s, x * s + y * c));
        let mut around = Bounds::EMPTY;
        let mut add = |x: f64, y: f64| {
            if left <= x && x <= right {
                let (low, high) = ([x, y, bounds.low[2]], [x, y, bounds.high[2]]);
                around = around.hull(Bounds::new(low, high));
            }
        };
        for i in 0..4 {
            let ((x0, y0), (x1, y1)) = (corners[i], corners[(i + 1) % 4]);
            add(x0, y0);
            for x in [left, right] {
                let t = (x - x0) / (x1 - x0);
                if (0.0..=1.0).contains(&t) {
                    add(x, y0 + t * (y1 - y0));
                }
            }
        }
        if around.is_empty() {
            return around;
        }
        around.low[0] = (around.low[0] - room).max(strip[0]);
        around.high[0] = (around.high[0] + room).min(strip[1]);
        around.low[1] -= room;
        around.high[1] += room;
        around
    }

    /// The boxes of all slabs of x from `low` to `high`, as one.
    fn slabs(low: f64, high: f64, slab: impl Fn([f64; 2]) -> Bounds) -> Bounds {
        let place = |i: u32| low + (high - low) * f64::from(i) / f64::from(SLABS);
        (0..SLABS).fold(Bounds::EMPTY, |all, i| {
            let piece = slab([place(i), place(i + 1)]);
            if piece.is_empty() {
                all
            } else {
                all.hull(piece)
            }
        })
    }

    /// The largest distance from the z axis in `region`.
    fn radius(region: &Bounds) -> f64 {
        region.reach(0).hypot(region.reach(1))
    }
}

/// The box without borders in the plane.
fn endless(bounds: Bounds) -> Bounds {
    let (low, high) = (f64::NEG_INFINITY, f64::INFINITY);
    Bounds::new([low, low, bounds.low[2]], [high, high, bounds.high[2]])
}

impl Modifier for Bend {
    const RULE: &'static str = "times the norm of the Jacobian, at most 1 + |rate| r with r the distance from the z axis: the norm is \
         convex, so it is largest at a corner of the region";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        let angle = p.x * N::splat(self.rate);
        let (s, c) = angle.sin_cos();
        child(&Vec3::new(c * p.x - s * p.y, s * p.x + c * p.y, p.z))
    }

    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds {
        let bounds = child(level);
        if bounds.is_empty() || self.rate == 0.0 {
            return bounds;
        }
        // Bending keeps the distance from the z axis, so x stays within it.
        let radius = Self::radius(&bounds);
        if !radius.is_finite() {
            return endless(bounds);
        }
        Self::slabs(-radius, radius, |strip| {
            Self::turned(&bounds, strip.map(|x| -self.rate * x), strip, radius)
        })
    }

    fn domain(&self, region: Bounds) -> Bounds {
        if region.is_empty() || self.rate == 0.0 {
            return region;
        }
        let radius = Self::radius(&region);
        if !radius.is_finite() {
            return endless(region);
        }
        Self::slabs(region.low[0], region.high[0], |strip| {
            let mut slab = region;
            (slab.low[0], slab.high[0]) = (strip[0], strip[1]);
            Self::turned(
                &slab,
                strip.map(|x| self.rate * x),
                [-2.0 * radius, 2.0 * radius],
                radius,
            )
        })
    }

    fn lipschitz(&self, child: f64, region: Bounds) -> f64 {
        if self.rate == 0.0 || region.is_empty() {
            return child;
        }
        if !Self::radius(&region).is_finite() {
            return f64::INFINITY;
        }
        let stretches = corners(&region, 0, 1).map(|(x, y)| self.stretch(x, y));
        child * stretches.into_iter().fold(1.0, f64::max)
    }

    fn is_regional(&self) -> bool {
        self.rate != 0.0
    }

    fn traits(&self, child: &Traits) -> Traits {
        if self.rate == 0.0 {
            return *child;
        }
        let [x, _, z] = child.is_symmetric;
        Traits {
            class: Class::Lipschitz,
            is_convex: false,
            is_symmetric: [x, false, z],
            ..*child
        }
    }
}
