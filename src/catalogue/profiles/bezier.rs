//! The stroke along a quadratic Bezier curve.

use crate::catalogue::plane_geometry::bounds_around;
use crate::catalogue::{Bounds, Class, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A stroke along a quadratic Bezier curve in the plane, with round ends.
    Bezier = "bezier" {
        /// Where the curve begins.
        a: [f64; 2], Vector2, Range::ANY, default [-0.8, -0.4];
        /// The control point, towards which it leaves `a` and from which it reaches `c`.
        b: [f64; 2], Vector2, Range::ANY, default [0.0, 1.2];
        /// Where the curve ends.
        c: [f64; 2], Vector2, Range::ANY, default [0.8, -0.4];
        /// The full width of the stroke, in scene units.
        width: f64, Number, Range::POSITIVE, default 0.2;
    }
    derived {
        halves: Vec<Half> = halves(a, b, c);
    }
    source "Quilez, 2D distance functions (quadratic Bezier), the cubic solved by Halley's method from the ends; a distance from the curve, so its constant is 1"
    example "bezier([-0.8, -0.4], [0, 1.2], [0.8, -0.4], 0.2).extrude(0.3)"
}

/// Steps of Halley's method: the distance is off by less than 1e-10 then, on the evolute too (measured).
const STEPS: usize = 9;

/// The part of the curve from one end to the vertex of its parabola: `end + 2 s tangent + s^2 bend`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Half {
    end: [f64; 2],
    tangent: [f64; 2],
    bend: [f64; 2],
    /// The parameter of the vertex, from 0 to 1.
    vertex: f64,
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

impl Half {
    /// The part near the end `a` of the curve with control point `b` and other end `c`.
    fn new(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Self {
        let tangent = [b[0] - a[0], b[1] - a[1]];
        let bend = [a[0] - 2.0 * b[0] + c[0], a[1] - 2.0 * b[1] + c[1]];
        let squared = dot(bend, bend);
        let vertex = if squared > 0.0 {
            (-dot(tangent, bend) / squared).clamp(0.0, 1.0)
        } else {
            1.0
        };
        Self {
            end: a,
            tangent,
            bend,
            vertex,
        }
    }

    /// The distance to the part, where the nearest point of the whole curve lies on it; else not less than that.
    ///
    /// Half the derivative of the squared distance is a cubic in the parameter, concave up to the vertex: where it is
    /// negative at the end, steps from there never pass its first root, the only one where the distance is smallest.
    #[inline(always)]
    fn distance<N: Number>(&self, x: N, y: N) -> N {
        let (t, e) = (self.tangent, self.bend);
        let (u, v) = (N::splat(self.end[0]) - x, N::splat(self.end[1]) - y);
        let c0 = u * N::splat(t[0]) + v * N::splat(t[1]);
        let c1 = u * N::splat(e[0]) + v * N::splat(e[1]) + N::splat(2.0 * dot(t, t));
        let (c2, c3) = (3.0 * dot(t, e), dot(e, e));
        let (zero, vertex) = (N::splat(0.0), N::splat(self.vertex));
        let mut s = zero;
        for _ in 0..STEPS {
            let value = c0 + s * (c1 + s * (N::splat(c2) + s * N::splat(c3)));
            let slope = c1 + s * (N::splat(2.0 * c2) + s * N::splat(3.0 * c3));
            let curvature = N::splat(2.0 * c2) + s * N::splat(6.0 * c3);
            let squared = slope.square();
            let step =
                (value + value) * slope / (squared + squared - value * curvature).max(squared);
            // Where the slope is not positive, no root is left before the vertex.
            s = N::select_lt(zero, slope, s - step, vertex).clamp(zero, vertex);
        }
        let dx = u + s * (N::splat(2.0 * t[0]) + s * N::splat(e[0]));
        let dy = v + s * (N::splat(2.0 * t[1]) + s * N::splat(e[1]));
        u.hypot(v).min(dx.hypot(dy))
    }
}

/// Both parts, or the one that is the whole curve.
fn halves(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Vec<Half> {
    let [first, last] = [Half::new(a, b, c), Half::new(c, b, a)];
    if last.vertex == 0.0 {
        return vec![Half {
            vertex: 1.0,
            ..first
        }];
    }
    if first.vertex == 0.0 {
        return vec![Half {
            vertex: 1.0,
            ..last
        }];
    }
    vec![first, last]
}

impl Bezier {
    /// The point at the parameter `t`.
    fn at(&self, t: f64) -> [f64; 2] {
        let mix = |i: usize| {
            (1.0 - t) * ((1.0 - t) * self.a[i] + 2.0 * t * self.b[i]) + t * t * self.c[i]
        };
        [mix(0), mix(1)]
    }

    /// The smallest radius of curvature; 0 for a curve that turns back on itself.
    fn radius(&self) -> f64 {
        let Half {
            tangent: t,
            bend: e,
            vertex,
            ..
        } = Half::new(self.a, self.b, self.c);
        let [x, y] = [t[0] + vertex * e[0], t[1] + vertex * e[1]];
        let speed = x.hypot(y);
        let turn = (t[0] * e[1] - t[1] * e[0]).abs();
        if speed == 0.0 {
            0.0
        } else {
            2.0 * speed.powi(3) / turn
        }
    }
}

impl Primitive for Bezier {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let mut nearest = N::splat(f64::INFINITY);
        for half in &self.halves {
            nearest = nearest.min(half.distance(p.x, p.y));
        }
        nearest - N::splat(0.5 * self.width)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let Half { tangent, bend, .. } = Half::new(self.a, self.b, self.c);
        let extremes = [0, 1].map(|i| -tangent[i] / bend[i]);
        let inner = extremes.into_iter().filter(|t| (0.0..=1.0).contains(t));
        let points: Vec<_> = inner.map(|t| self.at(t)).chain([self.a, self.c]).collect();
        bounds_around(&points, 0.5 * self.width + level)
    }

    fn traits(&self) -> Traits {
        Traits {
            // Inside of a bend that is sharper than the stroke is wide, the surface is further away.
            class: if 0.5 * self.width <= self.radius() {
                Class::Exact
            } else {
                Class::Bound
            },
            ..Traits::EXACT
        }
        .planar()
    }
}
