//! The ellipse.

use crate::catalogue::{Bounds, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A disc stretched along the axes, around the origin of the plane.
    Ellipse = "ellipse" {
        /// The semi-axes along x and y, in scene units.
        radii: [f64; 2], Vector2, Range::POSITIVE, default [0.9, 0.5];
    }
    source "the nearest point as an eigenvalue problem (More and Sorensen 1983), polished by osculating circles (Chou); a distance, so its constant is 1"
    example "ellipse([0.9, 0.5]).extrude(0.4)"
}

/// Steps of Newton's method on the secular equation: they come close from anywhere, slowly near the evolute.
const SECULAR_STEPS: usize = 4;

/// Steps with the circle of curvature: quick near the nearest point, off by less than 1e-9 on the evolute's cusps too
/// (measured, for semi-axes up to 1 to 1000).
const CIRCLE_STEPS: usize = 10;

impl Primitive for Ellipse {
    /// The signed distance from the tangent at the nearest point `(a c, b s)` with `c^2 + s^2 = 1`, which is smooth
    /// through the surface, and right to second order where `(c, s)` is slightly off.
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let [width, height] = self.radii;
        let is_upright = height > width;
        let (a, b) = (width.max(height), width.min(height));
        let (x, y) = if is_upright {
            (p.y.abs(), p.x.abs())
        } else {
            (p.x.abs(), p.y.abs())
        };
        let (mut c, mut s) = secular(a, b, x, y);
        for _ in 0..CIRCLE_STEPS {
            (c, s) = towards(a, b, x, y, c, s);
        }
        let (a, b) = (N::splat(a), N::splat(b));
        let (u, v) = (b * c, a * s);
        ((x - a * c) * u + (y - b * s) * v) / u.hypot(v)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let [a, b] = self.radii.map(|r| r + level);
        Bounds::centred([a, b, f64::INFINITY])
    }

    fn traits(&self) -> Traits {
        Traits::CONVEX.planar()
    }
}

/// Close to the parameters of the point nearest to `(x, y)`, both not negative, for `a >= b`.
///
/// They are `c = a x / (w + k)` and `s = b y / w` with `k = a^2 - b^2`, where `w > 0` makes `F = c^2 + s^2` equal to 1.
/// Since `1 / sqrt(F)` is concave in `w` and the start lies below the root, Newton's steps on it never pass the root.
#[inline(always)]
fn secular<N: Number>(a: f64, b: f64, x: N, y: N) -> (N, N) {
    let k = N::splat((a - b) * (a + b));
    // A height of nearly 0 instead of 0 keeps the quotient s.
    let (ax, by) = (
        x * N::splat(a),
        (y * N::splat(b)).max(N::splat(1e-18 * a * a)),
    );
    let mut w = by.max(ax.hypot(by) - k);
    for _ in 0..SECULAR_STEPS {
        let (c, s) = (ax / (w + k), by / w);
        let sum = c.square() + s.square();
        w = w + sum * (sum.sqrt() - N::splat(1.0)) / (c.square() / (w + k) + s.square() / w);
    }
    let (c, s) = (ax / (w + k), by / w);
    let length = c.hypot(s);
    (c / length, s / length)
}

/// Closer to them: the point towards `(x, y)` on the circle of curvature, brought back to the ellipse.
#[inline(always)]
fn towards<N: Number>(a: f64, b: f64, x: N, y: N, c: N, s: N) -> (N, N) {
    let (zero, one) = (N::splat(0.0), N::splat(1.0));
    let k = (a - b) * (a + b);
    let (centre_x, centre_y) = (
        c * c.square() * N::splat(k / a),
        s * s.square() * N::splat(-k / b),
    );
    let radius = (N::splat(a) * c - centre_x).hypot(N::splat(b) * s - centre_y);
    let (u, v) = (x - centre_x, y - centre_y);
    let away = u.hypot(v);
    let factor = N::select_lt(zero, away, radius / away, one);
    let next_c = ((u * factor + centre_x) * N::splat(1.0 / a)).clamp(zero, one);
    let next_s = ((v * factor + centre_y) * N::splat(1.0 / b)).clamp(zero, one);
    let length = next_c.hypot(next_s);
    (
        N::select_lt(zero, length, next_c / length, c),
        N::select_lt(zero, length, next_s / length, s),
    )
}
