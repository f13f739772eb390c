//! The tube.

use crate::catalogue::space_geometry::{dot, minus, norm, segment_distance};
use crate::catalogue::{Bounds, Class, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

entry! {
    /// A bent bar with round ends along a quadratic Bezier curve.
    Tube = "tube" {
        /// Where the curve starts, in scene units.
        a: [f64; 3], Vector3, Range::ANY, default [-0.8, -0.4, 0.0];
        /// The point that bends the curve: it leaves a towards b, and reaches c from b.
        b: [f64; 3], Vector3, Range::ANY, default [0.0, 1.2, 0.0];
        /// Where the curve ends.
        c: [f64; 3], Vector3, Range::ANY, default [0.8, -0.4, 0.0];
        /// The radius of the bar, in scene units.
        radius: f64, Number, Range::POSITIVE, default 0.15;
    }
    derived {
        // In a box of its own, or nodes would be larger for every solid.
        curve: Box<Curve> = Box::new(Curve::new(a, b, c));
    }
    source "Quilez, distance functions (quadratic Bezier); a distance, so its constant is 1"
    example "tube([-0.8, -0.5, 0.2], [0, 1.4, 0], [0.8, -0.5, -0.2], 0.15)"
}

/// The curve a + 2 t start + t^2 bend for t in [0, 1]: a piece of a parabola, whose vertex is at `vertex_at`.
#[derive(Clone, Debug, PartialEq)]
struct Curve {
    start: [f64; 3],
    bend: [f64; 3],
    vertex_at: f64,
    vertex: [f64; 3],
    /// The speed at the vertex, orthogonal to `bend`.
    speed: [f64; 3],
}

/// How much shorter than the way from a to b the bend is where the curve counts as a segment: its middle is then off
/// by a quarter of that.
const STRAIGHT: f64 = 1e-10;

/// The sum of vectors with factors.
fn sum(terms: [(f64, [f64; 3]); 3]) -> [f64; 3] {
    std::array::from_fn(|i| terms.iter().map(|(factor, v)| factor * v[i]).sum())
}

impl Curve {
    fn new(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> Self {
        let start = minus(b, a);
        let bend = minus(minus(c, b), start);
        let squared = dot(bend, bend);
        let vertex_at = if squared > 0.0 {
            -dot(start, bend) / squared
        } else {
            0.0
        };
        Self {
            start,
            bend,
            vertex_at,
            vertex: sum([
                (1.0, a),
                (2.0 * vertex_at, start),
                (vertex_at * vertex_at, bend),
            ]),
            speed: sum([(2.0, start), (2.0 * vertex_at, bend), (0.0, a)]),
        }
    }

    fn is_straight(&self) -> bool {
        norm(self.bend) <= STRAIGHT * norm(self.start)
    }

    /// The smallest radius of curvature; infinite where the curve lies on a line.
    fn tightest(&self) -> f64 {
        let (bend, speed) = (norm(self.bend), norm(self.speed));
        if speed <= STRAIGHT * bend || self.is_straight() {
            return f64::INFINITY;
        }
        // The point next to the vertex.
        let from_vertex = self.vertex_at.clamp(0.0, 1.0) - self.vertex_at;
        speed.hypot(2.0 * bend * from_vertex).powi(3) / (2.0 * bend * speed)
    }

    /// The vector from `p` to the point of the curve at `t`, and the speed there.
    #[inline(always)]
    fn at<N: Number>(&self, from: Vec3<N>, t: N) -> (Vec3<N>, Vec3<N>) {
        let (start, bend) = (Vec3::splat(self.start), Vec3::splat(self.bend));
        let half_speed = start + bend * t;
        (from + (start + half_speed) * t, half_speed + half_speed)
    }

    /// The distance to the point of the curve near `t`, from which `from` points to the start.
    #[inline(always)]
    fn near<N: Number>(&self, from: Vec3<N>, t: N) -> N {
        let (zero, one) = (N::splat(0.0), N::splat(1.0));
        let t = t.clamp(zero, one);
        // One step of Newton removes what rounding left. Not towards a maximum, nor where two roots meet.
        let (offset, speed) = self.at(from, t);
        let bend = Vec3::splat(self.bend);
        let slope = offset.dot(speed);
        let rise = speed.length_squared() + offset.dot(bend + bend);
        let turn = speed.dot(bend) * N::splat(24.0);
        let is_safe = rise * rise.abs() - (slope * turn).abs();
        let step = N::select_lt(zero, is_safe, slope / rise, zero);
        let (offset, _) = self.at(from, (t - step).clamp(zero, one));
        offset.length()
    }

    /// The distance to the curve, which starts at `a`. The squared distance is a quartic in t; its minima are the outer
    /// roots of u^3 + p u = q, where u is counted from the vertex.
    #[inline(always)]
    fn distance<N: Number>(&self, point: &Vec3<N>, a: [f64; 3]) -> N {
        let (zero, one) = (N::splat(0.0), N::splat(1.0));
        let w = *point - Vec3::splat(self.vertex);
        let scale = N::splat(0.5 / dot(self.bend, self.bend));
        let along_bend = w.dot(Vec3::splat(self.bend));
        let p = (N::splat(dot(self.speed, self.speed)) - along_bend - along_bend) * scale;
        let q = w.dot(Vec3::splat(self.speed)) * scale;
        let (sign, q) = (N::select_lt(q, zero, -one, one), q.abs());
        // The root of the sign of q, by Newton from above, where the cubic is convex.
        let lowest = (-p).max(zero);
        let mut near = lowest.sqrt() + q.pow(N::splat(1.0 / 3.0));
        for _ in 0..6 {
            let squared = near.square();
            let rise = squared + squared + squared + p;
            let next = ((squared + squared) * near + q) / rise;
            near = N::select_lt(zero, rise, next, zero);
        }
        // The other one, by the threefold angle; any point of the curve does no harm where there is none.
        let third = (lowest * N::splat(1.0 / 3.0)).sqrt();
        let cubed = third.square() * third;
        let ratio = N::select_lt(zero, cubed, q / (cubed + cubed), zero).min(one);
        let angle = ratio.cathetus().atan2(-ratio) * N::splat(1.0 / 3.0);
        let far = (third + third) * angle.cos();
        let (from, vertex_at) = (Vec3::splat(a) - *point, N::splat(self.vertex_at));
        self.near(from, vertex_at + sign * near)
            .min(self.near(from, vertex_at - sign * far))
    }
}

impl Primitive for Tube {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let line = if self.curve.is_straight() {
            segment_distance(p, self.a, self.c)
        } else {
            self.curve.distance(p, self.a)
        };
        line - N::splat(self.radius)
    }

    fn sublevel(&self, level: f64) -> Bounds {
        let ends = Bounds::around([self.a, self.c]);
        // Along each axis, the curve may turn back once.
        let turns = (0..3).map(|i| {
            let t = -self.curve.start[i] / self.curve.bend[i];
            let is_within = 0.0 < t && t < 1.0;
            let mut p = self.a;
            if is_within {
                p[i] += t * self.curve.start[i];
            }
            p
        });
        ends.hull(Bounds::around(turns))
            .inflate(self.radius + level)
    }

    fn traits(&self) -> Traits {
        // A tube wider than its tightest bend meets itself.
        let is_exact = self.radius <= self.curve.tightest();
        Traits {
            class: if is_exact { Class::Exact } else { Class::Bound },
            is_convex: self.curve.is_straight(),
            ..Traits::EXACT
        }
    }
}
