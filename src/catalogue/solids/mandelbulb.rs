//! The Mandelbulb.
//!
//! The solid holds the points c whose sequence `z -> z^n + c`, from z = c on, stays within the escape radius R for some
//! rounds. The power multiplies both angles of a point by n. At length a it stretches lengths by at most `n a^(n - 1)`
//! times the larger of 1 and `|sin(n t) / sin t|`, where t is the angle to the y axis: so at most by `n a^(n - 1) s`, with
//! s = n everywhere, and a smaller s outside of the double cone where `sin t < 1 / s`.
//!
//! The field is built backwards, from `h = |z| - R` after the last round. Take h with slope at most 1 in z and c together,
//! measured by the larger of the two changes. Then a change r of both changes h after a round by at most the integral of
//! `n s (a + x)^(n - 1) + 1` from 0 to r, which is at most `s ((b + r)^n - b^n)` for `b^(n - 1) = a^(n - 1) + 1 / (n s)`.
//! So the r for which this is h has slope at most 1 again: b moves no faster than a does. For s < n it counts as far as
//! the double cone is away. The largest r of several s, and of `|z| - R`, keeps the slope.

use crate::catalogue::{Bounds, Class, Primitive, Range, Traits, declaration::entry};
use crate::num::{Number, Vec3};

/// The most rounds.
const MOST: usize = 6;

/// The radius to which points are pulled back before a round, in escape radii, so that powers stay small.
const PULLED: f64 = 1.5;

/// The stretches s that are tried; besides these the power itself.
const STRETCHES: [f64; 3] = [1.1, 1.5, 2.5];

entry! {
    /// The Mandelbulb: the points that stay near when their angles are multiplied and their lengths raised to a power, again
    /// and again.
    Mandelbulb = "mandelbulb" {
        /// The power: one more than the number of bulbs around the y axis.
        power: f64, Count, Range::closed(2.0, 12.0), default 8.0;
        /// The number of rounds: more show finer detail, and take longer by far.
        iterations: f64, Count, Range::closed(1.0, MOST as f64), default 3.0;
    }
    derived {
        escape: f64 = 2.0_f64.powf(1.0 / (power - 1.0));
    }
    source "White and Nylander 2009 for the set; own bound: how far a round moves the points of a ball, solved backwards for its radius round by round, keeps the constant 1"
    example "mandelbulb(8, 3)"
}

/// The complex number `a + b i` to the power `n`, at least 1.
#[inline(always)]
fn complex_power<N: Number>(a: N, b: N, n: u32) -> (N, N) {
    let (mut x, mut y) = (a, b);
    for bit in (0..n.ilog2()).rev() {
        (x, y) = (x.square() - y.square(), (x + x) * y);
        if n >> bit & 1 == 1 {
            (x, y) = (x * a - y * b, x * b + y * a);
        }
    }
    (x, y)
}

/// The positive root of degree `n` of a positive number: square roots as far as they go, since these are cheap.
#[inline(always)]
fn root<N: Number>(x: N, n: u32) -> N {
    let mut root = x;
    for _ in 0..n.trailing_zeros() {
        root = root.sqrt();
    }
    match n >> n.trailing_zeros() {
        1 => root,
        odd => (root.ln() * N::splat(1.0 / f64::from(odd))).exp(),
    }
}

impl Mandelbulb {
    /// The point with its length raised to the power and both its angles multiplied.
    #[inline(always)]
    fn powered<N: Number>(&self, z: Vec3<N>) -> Vec3<N> {
        let n = self.power as u32;
        let around = z.x.hypot(z.z);
        let (height, across) = complex_power(z.y, around, n);
        let (cos, sin) = (z.x.direction_cosine(around), z.z.direction_cosine(around));
        let (cos, sin) = complex_power(cos, sin, n);
        Vec3::new(across * cos, height, across * sin)
    }

    /// How far from z a bound `h` of the distance after a round reaches before it, where the stretch is at most `s`.
    #[inline(always)]
    fn reach<N: Number>(&self, size: N, h: N, s: f64) -> N {
        let n = self.power;
        let b = root(
            size.powi(n as i32 - 1) + N::splat(1.0 / (n * s)),
            n as u32 - 1,
        );
        let gain = h * N::splat(1.0 / s);
        let end = root(b.powi(n as i32) + gain, n as u32);
        // end^n - b^n is (end - b) times this sum of products.
        let (mut sum, mut power) = (N::splat(1.0), N::splat(1.0));
        for _ in 1..n as u32 {
            power = power * b;
            sum = sum * end + power;
        }
        gain / sum
    }

    /// The bound of the distance before a round from `z`, given that after it.
    #[inline(always)]
    fn back<N: Number>(&self, z: Vec3<N>, size: N, h: N) -> N {
        let (zero, most) = (N::splat(0.0), h.abs());
        let around = z.x.hypot(z.z);
        let mut reach = self.reach(size, most, self.power);
        for s in STRETCHES.into_iter().filter(|s| *s < self.power) {
            let (sin, cos) = (1.0 / s, (1.0 - 1.0 / (s * s)).sqrt());
            let from_cone = around * N::splat(cos) - z.y.abs() * N::splat(sin);
            reach = reach.max(self.reach(size, most, s).min(from_cone));
        }
        N::select_lt(h, zero, -reach, reach)
    }
}

impl Primitive for Mandelbulb {
    #[inline(always)]
    fn distance<N: Number>(&self, p: &Vec3<N>) -> N {
        let (escape, limit) = (N::splat(self.escape), N::splat(PULLED * self.escape));
        let rounds = (self.iterations as usize).min(MOST);
        let mut passed = [(*p, escape); MOST];
        let mut z = *p;
        for place in &mut passed[..rounds] {
            let size = z.length();
            let pulled = z * (limit / size.max(limit));
            *place = (pulled, size);
            z = self.powered(pulled) + *p;
        }
        let mut field = z.length() - escape;
        for (z, size) in passed[..rounds].iter().rev() {
            field = self.back(*z, size.min(limit), field).max(*size - escape);
        }
        field
    }

    fn sublevel(&self, level: f64) -> Bounds {
        Bounds::centred([self.escape; 3]).inflate(level)
    }

    fn traits(&self) -> Traits {
        Traits {
            class: Class::Bound,
            ..Traits::EXACT
        }
    }
}
