//! Ranges with slopes that know more than their components: how long the gradient can be at most.
//!
//! The range of each partial derivative says little about a length: over a box around the origin all three components
//! of the gradient of |p| run from -1 to 1, but never reach it together. So every operation also carries a bound of the
//! gradient's length, by the chain rule: |f'(a)| |grad a|, and for a function of several operands the length of its own
//! gradient times the norm of their Jacobian. The smaller of both counts.

use super::{Dual, Interval, Lattice, Number};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The range of a field and of its partial derivatives over a region, with a bound of its slope.
#[derive(Clone, Copy, Debug)]
pub struct Steep {
    range: Dual<Interval, 3>,
    slope: f64,
}

/// A product of bounds, rounded up, in which zero times infinity is zero.
pub(super) fn times(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 {
        0.0
    } else {
        (a * b).next_up()
    }
}

/// The length of a vector whose components are at most these, rounded up.
pub(super) fn length(components: impl IntoIterator<Item = f64>) -> f64 {
    let length = components.into_iter().fold(0.0, f64::hypot);
    // Each `hypot` is off by at most one number.
    length.next_up().next_up().next_up()
}

impl Steep {
    /// The coordinate number `index` over the interval.
    pub fn variable(range: Interval, index: usize) -> Self {
        Self::new(Dual::variable(range, index), 1.0)
    }

    /// The largest slope: infinite where there is none, or where the field jumps.
    pub fn slope(&self) -> f64 {
        if self.slope.is_nan() {
            f64::INFINITY
        } else {
            self.slope
        }
    }

    /// The range of the value.
    pub fn value(&self) -> Interval {
        self.range.value
    }

    /// The ranges of the partial derivatives.
    pub fn gradient(&self) -> [Interval; 3] {
        self.range.partial
    }

    /// The range with the smaller of the given slope and what the components say.
    fn new(range: Dual<Interval, 3>, slope: f64) -> Self {
        let by_components = length(range.partial.map(Interval::magnitude));
        Self {
            range,
            slope: slope.min(by_components),
        }
    }

    /// A function of one number, with its derivative.
    fn one(self, f: impl Fn(Dual<Interval, 1>) -> Dual<Interval, 1>) -> Self {
        let y = f(Dual::variable(self.range.value, 0));
        let [derivative] = y.partial;
        let partial = self.range.partial.map(|d| d * derivative);
        let slope = times(derivative.magnitude(), self.slope);
        Self::new(Dual::new(y.value, partial), slope)
    }

    /// A function that was evaluated as `range`, of the `operands`, with a gradient by them that is at most `steepest`.
    fn of(range: Dual<Interval, 3>, operands: &[Self], steepest: f64) -> Self {
        Self::new(range, times(steepest, norm(operands)))
    }
}

/// The largest norm of the Jacobian of the operands: at most the root of the largest row sum of J J^T in absolute
/// values, of which the entries on the diagonal are the squared slopes; exact where the gradients are orthogonal.
pub(super) fn norm(operands: &[Steep]) -> f64 {
    let product =
        |a: &Steep, b: &Steep| -> f64 { dot(a, b).magnitude().min(times(a.slope, b.slope)) };
    let row = |i: usize| -> f64 {
        (0..operands.len())
            .map(|j| match i == j {
                true => times(operands[i].slope, operands[i].slope),
                false => product(&operands[i], &operands[j]),
            })
            .fold(0.0, |sum, x| (sum + x).next_up())
    };
    let largest = (0..operands.len()).map(row).fold(0.0, f64::max);
    let by_length = length(operands.iter().map(|a| a.slope));
    largest.sqrt().next_up().min(by_length)
}

/// The longest that the sum of two gradients can be, or their difference: |a + b|^2 = |a|^2 + |b|^2 + 2 a.b.
fn joined(a: &Steep, b: &Steep, sign: f64) -> f64 {
    let dot = dot(a, b) * Interval::point(2.0 * sign);
    let squares = times(a.slope, a.slope) + times(b.slope, b.slope);
    let by_angle = (squares.next_up() + dot.hi.max(0.0)).next_up().sqrt();
    by_angle.next_up().min((a.slope + b.slope).next_up())
}

/// The range of the scalar product of two gradients.
pub(super) fn dot(a: &Steep, b: &Steep) -> Interval {
    let pairs = a.range.partial.into_iter().zip(b.range.partial);
    pairs.fold(Interval::point(0.0), |sum, (x, y)| sum + x * y)
}

impl Add for Steep {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self::new(self.range + o.range, joined(&self, &o, 1.0))
    }
}

impl Sub for Steep {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self::new(self.range - o.range, joined(&self, &o, -1.0))
    }
}

impl Mul for Steep {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let [a, b] = [self.range.value, o.range.value].map(Interval::magnitude);
        let slope = times(a, o.slope) + times(b, self.slope);
        Self::new(self.range * o.range, slope.next_up())
    }
}

impl Div for Steep {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let range = self.range / o.range;
        let least = o.range.value.mignitude();
        let rise = self.slope + times(range.value.magnitude(), o.slope);
        let slope = match least > 0.0 {
            true => (rise.next_up() / least).next_up(),
            false => f64::INFINITY,
        };
        Self::new(range, slope)
    }
}

impl Neg for Steep {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            range: -self.range,
            ..self
        }
    }
}

impl Number for Steep {
    type Constant = f64;

    fn constant(x: f64) -> f64 {
        x
    }

    fn spread(x: f64) -> Self {
        Self {
            range: Dual::splat(x),
            slope: 0.0,
        }
    }

    fn min(self, o: Self) -> Self {
        Self::new(self.range.min(o.range), self.slope.max(o.slope))
    }

    fn max(self, o: Self) -> Self {
        Self::new(self.range.max(o.range), self.slope.max(o.slope))
    }

    fn abs(self) -> Self {
        Self::new(self.range.abs(), self.slope)
    }

    fn sqrt(self) -> Self {
        self.one(Number::sqrt)
    }

    fn floor(self) -> Self {
        self.one(Number::floor)
    }

    fn sin(self) -> Self {
        self.one(Number::sin)
    }

    fn cos(self) -> Self {
        self.one(Number::cos)
    }

    fn atan2(self, x: Self) -> Self {
        Self::new(self.range.atan2(x.range), f64::INFINITY)
    }

    fn exp(self) -> Self {
        self.one(Number::exp)
    }

    fn ln(self) -> Self {
        self.one(Number::ln)
    }

    fn select_lt(a: Self, b: Self, x: Self, y: Self) -> Self {
        let range = Dual::select_lt(a.range, b.range, x.range, y.range);
        let jumps = range.partial.contains(&Interval::ENTIRE);
        let slope = match jumps {
            true => f64::INFINITY,
            false => x.slope.max(y.slope),
        };
        Self::new(range, slope)
    }

    fn square(self) -> Self {
        self.one(Number::square)
    }

    /// Within [0, 1] the slopes of `a` and `b` are mixed too; what the share itself adds is its slope times their
    /// difference.
    fn mix(self, a: Self, b: Self) -> Self {
        let range = self.range.mix(a.range, b.range);
        let share = self.range.value;
        let of_ends = |t: f64| (times((1.0 - t).next_up(), a.slope) + times(t, b.slope)).next_up();
        let mixed = if share.lo >= 0.0 && share.hi <= 1.0 {
            of_ends(share.lo).max(of_ends(share.hi))
        } else {
            f64::INFINITY
        };
        let rise = (b.range.value - a.range.value).magnitude();
        Self::new(range, (mixed + times(rise, self.slope)).next_up())
    }

    fn ease(self) -> Self {
        self.one(Number::ease)
    }

    fn hypot(self, o: Self) -> Self {
        Self::of(self.range.hypot(o.range), &[self, o], 1.0)
    }

    fn norm3(x: Self, y: Self, z: Self) -> Self {
        let range = Dual::norm3(x.range, y.range, z.range);
        Self::of(range, &[x, y, z], 1.0)
    }

    fn pow(self, e: Self) -> Self {
        Self::new(self.range.pow(e.range), f64::INFINITY)
    }

    fn powi(self, n: i32) -> Self {
        self.one(|x| x.powi(n))
    }

    fn tan(self) -> Self {
        self.one(Number::tan)
    }

    fn asin(self) -> Self {
        self.one(Number::asin)
    }

    fn acos(self) -> Self {
        self.one(Number::acos)
    }

    fn lattice(lattice: Lattice, x: Self, y: Self, z: Self) -> Self {
        let range = Dual::lattice(lattice, x.range, y.range, z.range);
        Self::of(range, &[x, y, z], lattice.lipschitz())
    }
}

#[cfg(test)]
mod tests {
    use super::super::interval::tests::{point_of, random_interval};
    use super::super::samples::{Samples, Tree};
    use super::*;

    const SEED: u64 = 0x57ee;

    fn coordinates(region: [(f64, f64); 3]) -> [Steep; 3] {
        std::array::from_fn(|i| Steep::variable(Interval::new(region[i].0, region[i].1), i))
    }

    #[test]
    fn no_gradient_is_longer_than_the_slope() {
        let mut samples = Samples::new(SEED);
        let mut bounded = 0;
        for round in 0..4_000 {
            let tree = Tree::random(&mut samples, 1 + round % 4);
            let region = [0; 3].map(|_| random_interval(&mut samples));
            let steep = tree.value([0, 1, 2].map(|i| Steep::variable(region[i], i)));
            bounded += usize::from(steep.slope() < f64::INFINITY);
            for _ in 0..5 {
                let p = region.map(|x| point_of(x, &mut samples));
                let at = [0, 1, 2].map(|i| Dual::<f64, 3>::variable(p[i], i));
                let is_finite = |x: Dual<f64, 3>| {
                    x.value.is_finite() && x.partial.iter().all(|d| d.is_finite())
                };
                if !tree.all_steps(at, is_finite) {
                    continue;
                }
                let slope = tree.value(at).partial.into_iter().fold(0.0, f64::hypot);
                assert!(
                    slope <= steep.slope() * (1.0 + 1e-14),
                    "{tree:?} at {p:?} in {region:?}: {slope:e} above {:e}, seed {SEED:#x}",
                    steep.slope()
                );
            }
        }
        assert!(bounded > 1_000, "only {bounded} slopes are bounded");
    }

    #[test]
    fn slopes_of_lengths_and_noise_are_those_of_the_rules() {
        let [x, y, z] = coordinates([(-1.0, 1.0); 3]);
        let near = |found: f64, expected: f64| {
            assert!(
                found >= expected && found <= expected * (1.0 + 1e-12),
                "{found}, expected {expected}"
            );
        };
        near(Steep::norm3(x, y, z).slope(), 1.0);
        let f = Steep::splat(4.0);
        let wide = coordinates([(f64::MIN, f64::MAX); 3]).map(|c| c * f);
        let [u, v, w] = wide;
        near(Steep::lattice(Lattice::Noise, u, v, w).slope(), 15.0);
        near(Steep::lattice(Lattice::Voronoi, u, v, w).slope(), 4.0);
        // A rotation about z does not change a slope.
        let (s, c) = (Steep::splat(0.6), Steep::splat(0.8));
        let turned = Steep::norm3(c * x - s * y, s * x + c * y, z);
        near(turned.slope(), 1.0);
    }
}
