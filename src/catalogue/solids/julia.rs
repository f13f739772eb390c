//! The quaternion Julia set.
//!
//! The solid holds the points z that the map `z -> z^2 + c` keeps within the escape radius R for some rounds, cut where the
//! last component of z is 0. Its field is built backwards, from `h(z) = |z| - R` after the last round. If h has slope at
//! most 1, then so has
//!
//! ```text
//! s(z) = sqrt(|z|^2 + h(z^2 + c)) - |z|      (where h < 0: with its absolute value, and negated)
//! ```
//!
//! Proof: r = s(z) solves `2 |z| r + r^2 = h(z^2 + c)`. For w at distance d < r, quaternions have
//! `|w^2 - z^2| <= d (2 |z| + d)`, so `h(w^2 + c) >= (r - d) (2 |z| + r + d) >= (r - d) (2 |w| + r - d)`, since
//! `|w| <= |z| + d`: that is, `s(w) >= r - d`. Inside likewise, and across the surface the two add up.
//!
//! The larger of s and `|z| - R` keeps the slope and the sign, and makes the field a good distance far away too. Before
//! each round z is pulled back to a ball wider than R, which shortens distances and keeps what has escaped outside.

use crate::catalogue::enclosure::{beyond, enclosure};
use crate::catalogue::{Bounds, Class, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

/// The most rounds.
const MOST: usize = 16;

/// The radius to which points are pulled back, in escape radii: further out `|z| - R` is the larger anyway.
const PULLED: f64 = 4.0;

entry! {
    /// A filled quaternion Julia set of z^2 + c: the points x + y i + z j that stay near in all rounds.
    Julia = "julia" {
        /// The first three components of c: the real one, those of i and j.
        c: [f64; 3], Vector3, Range::closed(-2.0, 2.0), default [-0.291, -0.399, 0.339];
        /// The last component of c, that of k.
        w: f64, Number, Range::closed(-2.0, 2.0), default 0.437;
        /// The number of rounds: more show finer detail.
        iterations: f64, Count, Range::closed(1.0, MOST as f64), default 8.0;
    }
    derived {
        map: Map = Map::new([c[0], c[1], c[2], w], iterations);
        region: Bounds = enclosure(Bounds::centred([map.escape; 3]), |p| map.field(&Vec3::splat(p)));
    }
    source "Hart, Sandin and Kauffman 1989 for the set; own bound: a ball of radius r about z goes into one of radius 2 |z| r + r^2, solved backwards for r round by round, keeps the constant 1"
    example "julia([-0.291, -0.399, 0.339], 0.437, 8)"
}

/// A quaternion: the real component, then those of i, j and k.
type Quaternion<N> = [N; 4];

#[inline(always)]
fn length<N: Number>([a, b, c, d]: Quaternion<N>) -> N {
    (a.square() + b.square() + c.square() + d.square()).sqrt()
}

#[inline(always)]
fn square<N: Number>([a, b, c, d]: Quaternion<N>) -> Quaternion<N> {
    let real = a.square() - (b.square() + c.square() + d.square());
    let twice = a + a;
    [real, twice * b, twice * c, twice * d]
}

/// What is iterated.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Map {
    c: Quaternion<f64>,
    rounds: usize,
    /// The least R with `R^2 - |c| >= R`: what is further away never comes back.
    escape: f64,
}

impl Map {
    fn new(c: Quaternion<f64>, iterations: f64) -> Self {
        let size = length(c);
        Self {
            c,
            rounds: (iterations as usize).min(MOST),
            escape: 0.5 + (0.25 + size).sqrt(),
        }
    }

    /// The next of a sequence of points: pulled back to the ball of radius `limit`, squared, moved by c.
    #[inline(always)]
    fn next<N: Number>(&self, [a, b, c, d]: Quaternion<N>, size: N, limit: N) -> Quaternion<N> {
        let pull = limit / size.max(limit);
        let [a, b, c, d] = square([a * pull, b * pull, c * pull, d * pull]);
        [
            a + N::splat(self.c[0]),
            b + N::splat(self.c[1]),
            c + N::splat(self.c[2]),
            d + N::splat(self.c[3]),
        ]
    }

    /// A bound of the distance to what has not escaped.
    #[inline(always)]
    fn field<N: Number>(&self, p: &Vec3<N>) -> N {
        let (escape, limit) = (N::splat(self.escape), N::splat(PULLED * self.escape));
        let rounds = self.rounds;
        let mut sizes = [N::splat(0.0); MOST];
        let mut z = [p.x, p.y, p.z, N::splat(0.0)];
        for size in &mut sizes[..rounds] {
            *size = length(z);
            z = self.next(z, *size, limit);
        }
        let mut field = length(z) - escape;
        for size in sizes[..rounds].iter().rev() {
            let pulled = size.min(limit);
            let root = (pulled.square() + field.abs()).sqrt();
            // h / (root + |z|) is root - |z| without cancellation, and has the sign of h.
            let back = field / (root + pulled).max(N::splat(1e-30));
            field = back.max(*size - escape);
        }
        field
    }
}

impl Primitive for Julia {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        self.map.field(p).max(beyond(&self.region, p))
    }

    fn sublevel(&self, level: f64) -> Bounds {
        self.region.inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits {
            class: Class::Bound,
            ..Traits::EXACT
        }
    }
}
