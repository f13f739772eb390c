//! Repetition around an axis.
//!
//! Along a circle about the axis, distances from a point grow with the angle. So the nearest point of all copies is
//! in one whose middle is no further, in angle, than half a step and half the angle w that the child's box takes: else
//! the next copy has the same point nearer. Of an exact child, the K >= 1 + w / step copies whose middles are the
//! nearest are asked; of other children all, unless the child is the same on both sides of its sector and stays in it:
//! then its own sector's copy does.

use super::rotate::sin_cos;
use super::sweep::{corners, swept};
use crate::catalogue::{Axis, Bounds, Class, Modifier, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};
use std::f64::consts::{PI, TAU};

entry! {
    /// Repeats a shape around an axis, in equal steps of a full turn; the shape itself is the first copy.
    Polar = "polar" {
        /// The number of copies, the shape itself included.
        count: f64, Count, Range::closed(1.0, 10_000.0);
        /// The axis that the copies stand around.
        axis: Axis, Axis, Range::ANY, default Axis(1);
    }
    derived {
        step: f64 = TAU / count;
        asked: f64 = count;
        middle: f64 = 0.0;
    }
    source "the nearest copies in angle, which hold the nearest point; rotations keep the constant (Hart 1996)"
    example "box([0.5, 0.3, 0.15]).translate([0.7, 0, 0]).polar(9)"
}

/// No more copies are asked than this.
const MOST_ASKED: f64 = 64.0;

impl Polar {
    /// The axes across, in the order in which a turn takes one to the other.
    fn across(&self) -> (usize, usize) {
        ((self.axis.0 + 1) % 3, (self.axis.0 + 2) % 3)
    }

    /// The point turned back by the angle with this sine and cosine.
    #[inline(always)]
    fn turned<N: Number>(&self, p: &Vec3<N>, s: N, c: N) -> Vec3<N> {
        let (u, v) = self.across();
        let (x, y) = (p.component(u), p.component(v));
        p.with_component(u, x * c + y * s)
            .with_component(v, y * c - x * s)
    }

    /// The middle and the width of the angle that a box takes; none where it holds the axis.
    fn angle(&self, bounds: &Bounds) -> Option<(f64, f64)> {
        let (u, v) = self.across();
        let holds = |i: usize| bounds.low[i] <= 0.0 && bounds.high[i] >= 0.0;
        let is_finite = [u, v].iter().all(|i| bounds.size()[*i].is_finite());
        if !is_finite || (holds(u) && holds(v)) {
            return None;
        }
        let centre = bounds.centre();
        let middle = libm::atan2(centre[v], centre[u]);
        let mut range = [0.0_f64; 2];
        for (x, y) in corners(bounds, u, v) {
            let beside = (libm::atan2(y, x) - middle + PI).rem_euclid(TAU) - PI;
            range = [range[0].min(beside), range[1].max(beside)];
        }
        Some((middle + 0.5 * (range[0] + range[1]), range[1] - range[0]))
    }
}

impl Modifier for Polar {
    const RULE: &'static str =
        "the smallest of the child's copies, each an isometry (Hart 1996, section 3)";

    #[inline(always)]
    fn apply<N: Number>(&self, p: &Vec3<N>, child: impl Fn(&Vec3<N>) -> N) -> N {
        if self.asked >= self.count {
            let mut nearest = child(p);
            for i in 1..self.count as u32 {
                let (s, c) = sin_cos(f64::from(i) * self.step);
                nearest = nearest.min(child(&self.turned(p, N::splat(s), N::splat(c))));
            }
            return nearest;
        }
        let (u, v) = self.across();
        let angle = p.component(v).atan2(p.component(u)) - N::splat(self.middle);
        let first = (angle / N::splat(self.step) + N::splat(1.0 - 0.5 * self.asked)).floor();
        let mut nearest = N::splat(f64::INFINITY);
        for i in 0..self.asked as u32 {
            let turn = (first + N::splat(f64::from(i))) * N::splat(self.step);
            let (sine, cosine) = turn.sin_cos();
            nearest = nearest.min(child(&self.turned(p, sine, cosine)));
        }
        nearest
    }

    fn sublevel(&self, level: f64, child: &dyn Fn(f64) -> Bounds) -> Bounds {
        let copy = child(level);
        if self.count > MOST_ASKED {
            return swept(copy, self.axis.0, [0.0, TAU], [1.0; 2]);
        }
        (0..self.count as u32).fold(Bounds::EMPTY, |all, i| {
            let turn = f64::from(i) * self.step;
            all.hull(swept(copy, self.axis.0, [turn; 2], [1.0; 2]))
        })
    }

    fn domain(&self, region: Bounds) -> Bounds {
        if region.is_empty() || self.count == 1.0 {
            return region;
        }
        if self.asked >= self.count {
            return self.sublevel(0.0, &|_| region);
        }
        // A wedge around the child's own sector, as long as the region reaches.
        let (u, v) = self.across();
        let radius = region.reach(u).hypot(region.reach(v));
        let mut edge = region;
        (edge.low[u], edge.high[u]) = (0.0, radius);
        (edge.low[v], edge.high[v]) = (0.0, 0.0);
        let half = 0.5 * self.asked * self.step;
        swept(
            edge,
            self.axis.0,
            [self.middle - half, self.middle + half],
            [1.0; 2],
        )
    }

    fn lipschitz(&self, child: f64, _: Bounds) -> f64 {
        child
    }

    fn traits(&self, child: &Traits) -> Traits {
        if self.count == 1.0 {
            return *child;
        }
        let (u, v) = self.across();
        let mut is_symmetric = child.is_symmetric;
        if self.count % 2.0 == 0.0 {
            // With half a turn, one mirror makes the other.
            let is_any = child.is_symmetric[u] || child.is_symmetric[v];
            (is_symmetric[u], is_symmetric[v]) = (is_any, is_any);
        }
        Traits {
            class: child.class.min(Class::Bound),
            is_convex: false,
            is_symmetric,
            ..*child
        }
    }

    fn fit(
        &mut self,
        child: &Traits,
        sublevel: &dyn Fn(f64) -> Bounds,
    ) -> Result<(), (String, String)> {
        if child.is_planar && self.axis.0 != 2 {
            let problem = "a profile can only be repeated around the z axis".into();
            let count = self.count;
            return Err((
                problem,
                format!("write `polar({count}, \"z\")`, or extrude it first"),
            ));
        }
        let bounds = sublevel(0.0);
        if bounds.is_empty() {
            (self.asked, self.middle) = (1.0, 0.0);
            return Ok(());
        }
        let (u, v) = self.across();
        if let Some((middle, width)) = self.angle(&bounds) {
            // A child that is the same on both sides of an axis of its box lies along the other.
            let is_mirrored = (child.is_symmetric[v] && bounds.low[v] == -bounds.high[v])
                || (child.is_symmetric[u] && bounds.low[u] == -bounds.high[u]);
            let is_own = is_mirrored && width <= self.step;
            if is_own || child.class == Class::Exact {
                let least = if is_own {
                    1.0
                } else {
                    (1.0 + width / self.step).ceil()
                };
                (self.asked, self.middle) = (least.min(self.count), middle);
            }
        }
        if self.asked <= MOST_ASKED {
            return Ok(());
        }
        let asked = self.asked;
        Err((
            format!("{asked} copies of this shape have to be asked everywhere, more than {MOST_ASKED}"),
            "use fewer copies, or a shape that does not reach over the axis and is the same on both sides of its sector"
                .into(),
        ))
    }
}
