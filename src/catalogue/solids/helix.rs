//! The helix.

use crate::catalogue::{Bounds, Class, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

entry! {
    /// A wire wound around the y axis like a spring, right-handed, with round ends, its middle on the positive x axis.
    Helix = "helix" {
        /// The distance of the middle of the wire from the axis, in scene units.
        radius: f64, Number, Range::POSITIVE, default 0.6;
        /// How far the wire climbs in one turn, in scene units.
        pitch: f64, Number, Range::POSITIVE, default 0.4;
        /// The number of turns, which need not be whole.
        turns: f64, Number, Range::POSITIVE, default 3.0;
        /// The full thickness of the wire.
        thickness: f64, Number, Range::POSITIVE, default 0.16;
    }
    derived {
        climb: f64 = pitch / TAU;
        end: f64 = PI * turns;
    }
    source "the nearest turn by Kepler's equation, by Halley's steps from above; a distance, so its constant is 1"
    example "helix(0.6, 0.4, 3, 0.16)"
}

/// The root of e sin(x) + x = m for `m` in [0, pi], which is in [0, m]; for larger `m` the first one, while there is
/// any in [0, pi].
///
/// In u = pi - x it is Kepler's equation u - e sin(u) = pi - m, convex in u, of which the largest root is wanted. The
/// steps start above it, from the root of a cubic, as sin(u) <= u - u^3 / pi^2.
#[inline(always)]
fn anomaly<N: Number>(e: N, m: N) -> N {
    let (zero, half, one, pi) = (N::splat(0.0), N::splat(0.5), N::splat(1.0), N::splat(PI));
    let left = pi - m;
    // u^3 + p u = q; a larger e has a larger root, and spares the division by 0.
    let steep = N::splat(PI * PI) / e.max(N::splat(0.05));
    let (p, q) = (steep - N::splat(PI * PI), steep * left);
    let lowest = (-p).max(zero);
    let mut u = lowest.sqrt() + q.max(zero).pow(N::splat(1.0 / 3.0));
    for _ in 0..2 {
        let squared = u.square();
        let rise = squared + squared + squared + p;
        u = N::select_lt(zero, rise, ((squared + squared) * u + q) / rise, u);
    }
    u = u.clamp(zero, pi);
    for _ in 0..STEPS {
        // Halley's step, as the second derivative comes for free.
        let (sine, cosine) = u.sin_cos();
        let (lift, rise) = (e * sine, one - e * cosine);
        let excess = u - lift - left;
        let slope = rise.square() - half * (excess * lift);
        u = N::select_lt(zero, slope, u - excess * rise / slope, u).clamp(zero, pi);
    }
    pi - u
}

/// How many of Halley's steps: full precision, but for 1e-10 of the distance where two roots meet at an end.
const STEPS: usize = 6;

impl Helix {
    /// The point at an angle of the wire's middle line.
    fn point(&self, angle: f64) -> [f64; 3] {
        let (sine, cosine) = angle.sin_cos();
        [
            self.radius * cosine,
            self.climb * angle,
            -self.radius * sine,
        ]
    }

    /// The largest radius of a wire that does not meet itself, or a little less.
    fn reach(&self) -> f64 {
        const SAMPLES: u32 = 512;
        let curvature = self.radius + self.climb * (self.climb / self.radius);
        // Half the distance of two points apart by an angle, from half a turn on; sampled, so less what lies between.
        let most = (2.0 * self.end).min(TAU);
        let step = (most - PI).max(0.0) / f64::from(SAMPLES);
        let gaps = (0..=SAMPLES).map(|i| {
            let angle = PI + step * f64::from(i);
            (self.radius * (0.5 * angle).sin()).hypot(0.5 * self.climb * angle)
        });
        let gap = gaps.fold(f64::INFINITY, f64::min) - 0.5 * step * self.radius.hypot(self.climb);
        if most > PI {
            curvature.min(gap)
        } else {
            curvature
        }
    }
}

impl Primitive for Helix {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let (zero, one, half, turn) = (N::splat(0.0), N::splat(1.0), N::splat(0.5), N::splat(TAU));
        let (radius, climb, end) = (
            N::splat(self.radius),
            N::splat(self.climb),
            N::splat(self.end),
        );
        let angle = (-p.z).atan2(p.x);
        let e = p.x.hypot(p.z) * N::splat(self.radius / self.climb / self.climb);
        // Where the wire is at the height of the point.
        let level = p.y * N::splat(1.0 / self.climb);
        let nearest = ((level - angle) / turn + half).floor();
        let last = ((end - angle) / turn).floor();
        let first = -(((end + angle) / turn).floor());
        let [top, bottom] = [self.point(self.end), self.point(-self.end)];
        let from_ends = (*p - Vec3::splat(top))
            .length()
            .min((*p - Vec3::splat(bottom)).length());
        let mut line = from_ends;
        // The turn next to the point, and where that is beyond an end, the last or first one of the wire.
        let others = [nearest.min(last).max(first), nearest.min(last)];
        let others = if self.turns < 1.0 {
            [nearest.max(first), others[1]]
        } else {
            others
        };
        let count = if self.turns < 1.0 { 2 } else { 1 };
        for n in std::iter::once(nearest).chain(others.into_iter().take(count)) {
            let start = angle + n * turn;
            let ahead = level - start;
            let sign = N::select_lt(ahead, zero, -one, one);
            let foot = (start + sign * anomaly(e, ahead.abs())).clamp(-end, end);
            let (sine, cosine) = foot.sin_cos();
            let (x, z) = (radius * cosine, -(radius * sine));
            line = line.min(N::norm3(p.x - x, p.y - climb * foot, p.z - z));
        }
        line - N::splat(0.5 * self.thickness)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let low = self.radius * self.end.min(PI).cos();
        let side = self.radius * self.end.min(FRAC_PI_2).sin();
        let height = self.climb * self.end;
        Bounds::new([low, -height, -side], [self.radius, height, side])
            .inflate(0.5 * self.thickness + level)
    }

    fn traits(&self) -> Traits {
        // A wire thicker than the gap between its turns meets itself.
        let is_exact = 0.5 * self.thickness <= self.reach();
        Traits {
            class: if is_exact { Class::Exact } else { Class::Bound },
            ..Traits::EXACT
        }
    }
}
