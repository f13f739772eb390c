//! Dual numbers: a value with its exact partial derivatives.

#![allow(
    clippy::suspicious_arithmetic_impl,
    reason = "the rules of differentiation mix operators"
)]

use super::{Lattice, Number};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value and its derivatives with respect to `K` variables (forward automatic differentiation).
///
/// Over `f64` it gives gradients, hence normals; over an interval it gives the range of the gradient, hence Lipschitz
/// bounds. At a kink (`abs`, `min`, `max`) the derivative is that of one side; `sqrt` has derivative 0 at 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<N, const K: usize> {
    /// The value.
    pub value: N,
    /// The partial derivatives.
    pub partial: [N; K],
}

impl<N: Number, const K: usize> Dual<N, K> {
    /// The value `value` with derivatives `partial`.
    #[inline(always)]
    pub fn new(value: N, partial: [N; K]) -> Self {
        Self { value, partial }
    }

    /// The variable number `index` at `value`: its derivative by itself is 1.
    #[inline(always)]
    pub fn variable(value: N, index: usize) -> Self {
        let mut partial = [N::splat(0.0); K];
        partial[index] = N::splat(1.0);
        Self { value, partial }
    }

    /// `value` with every derivative scaled by `slope`: the chain rule.
    #[inline(always)]
    fn chain(self, value: N, slope: N) -> Self {
        let mut partial = self.partial;
        for d in &mut partial {
            *d = *d * slope;
        }
        Self { value, partial }
    }

    /// `value` with every derivative divided by `divisor`; 0 where the divisor is 0, not 0 / 0.
    #[inline(always)]
    fn chain_over(self, value: N, divisor: N) -> Self {
        let zero = N::splat(0.0);
        let slope = N::splat(1.0) / divisor;
        let mut partial = self.partial;
        for d in &mut partial {
            *d = N::select_lt(zero, divisor, *d * slope, zero);
        }
        Self { value, partial }
    }

    /// `value`, with derivatives combined pairwise by `f`.
    #[inline(always)]
    fn zip(self, other: Self, value: N, f: impl Fn(N, N) -> N) -> Self {
        let mut partial = self.partial;
        for (d, e) in partial.iter_mut().zip(other.partial) {
            *d = f(*d, e);
        }
        Self { value, partial }
    }
}

impl<N: Number, const K: usize> Add for Dual<N, K> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        self.zip(o, self.value + o.value, |a, b| a + b)
    }
}

impl<N: Number, const K: usize> Sub for Dual<N, K> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        self.zip(o, self.value - o.value, |a, b| a - b)
    }
}

impl<N: Number, const K: usize> Mul for Dual<N, K> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        let mut partial = self.partial;
        // In place: a longer closure falls out of a level of instructions.
        for (d, e) in partial.iter_mut().zip(o.partial) {
            *d = *d * o.value + self.value * e;
        }
        Self::new(self.value * o.value, partial)
    }
}

impl<N: Number, const K: usize> Div for Dual<N, K> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let quotient = self.value / o.value;
        let mut partial = self.partial;
        for (d, e) in partial.iter_mut().zip(o.partial) {
            *d = (*d - quotient * e) / o.value;
        }
        Self::new(quotient, partial)
    }
}

impl<N: Number, const K: usize> Neg for Dual<N, K> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let mut partial = self.partial;
        for d in &mut partial {
            *d = -*d;
        }
        Self::new(-self.value, partial)
    }
}

impl<N: Number, const K: usize> Number for Dual<N, K> {
    type Constant = N::Constant;

    const LEAVES_OUT: bool = N::LEAVES_OUT;

    #[inline(always)]
    fn may_be_below(self, other: Self) -> bool {
        self.value.may_be_below(other.value)
    }

    #[inline(always)]
    fn constant(x: f64) -> N::Constant {
        N::constant(x)
    }

    #[inline(always)]
    fn spread(x: N::Constant) -> Self {
        Self {
            value: N::spread(x),
            partial: [N::splat(0.0); K],
        }
    }

    #[inline(always)]
    fn min(self, o: Self) -> Self {
        // Continuous in both branches, so an undecided interval takes the hull of the slopes, not everything.
        self.zip(o, self.value.min(o.value), |a, b| {
            N::select_lt(o.value, self.value, b, a)
        })
    }

    #[inline(always)]
    fn max(self, o: Self) -> Self {
        self.zip(o, self.value.max(o.value), |a, b| {
            N::select_lt(self.value, o.value, b, a)
        })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let sign = N::select_lt(self.value, N::splat(0.0), N::splat(-1.0), N::splat(1.0));
        self.chain(self.value.abs(), sign)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain_over(root, root + root)
    }

    #[inline(always)]
    fn floor(self) -> Self {
        self.chain(self.value.floor(), self.value.floor_slope())
    }

    #[inline(always)]
    fn sin(self) -> Self {
        let (sine, cosine) = self.value.sin_cos();
        self.chain(sine, cosine)
    }

    #[inline(always)]
    fn cos(self) -> Self {
        let (sine, cosine) = self.value.sin_cos();
        self.chain(cosine, -sine)
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.value.sin_cos();
        (self.chain(sine, cosine), self.chain(cosine, -sine))
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let scale = self.value.square() + x.value.square();
        let zero = N::splat(0.0);
        self.zip(x, self.value.atan2(x.value), |dy, dx| {
            let slope = (x.value * dy - self.value * dx) / scale;
            self.value
                .atan2_slope(x.value, N::select_lt(zero, scale, slope, zero))
        })
    }

    #[inline(always)]
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.chain(value, value)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        self.chain(self.value.ln(), N::splat(1.0) / self.value)
    }

    #[inline(always)]
    fn select_lt(a: Self, b: Self, x: Self, y: Self) -> Self {
        let value = N::select_lt(a.value, b.value, x.value, y.value);
        x.zip(y, value, |dx, dy| {
            N::select_lt_slope(a.value, b.value, dx, dy)
        })
    }

    #[inline(always)]
    fn hypot(self, o: Self) -> Self {
        let length = self.value.hypot(o.value);
        let (u, v) = (
            self.value.direction_cosine(length),
            o.value.direction_cosine(length),
        );
        let mut partial = self.partial;
        for (d, e) in partial.iter_mut().zip(o.partial) {
            *d = u * *d + v * e;
        }
        Self {
            value: length,
            partial,
        }
    }

    #[inline(always)]
    fn norm3(x: Self, y: Self, z: Self) -> Self {
        let length = N::norm3(x.value, y.value, z.value);
        let u = x.value.direction_cosine(length);
        let v = y.value.direction_cosine(length);
        let w = z.value.direction_cosine(length);
        let mut partial = x.partial;
        for (d, (b, c)) in partial.iter_mut().zip(y.partial.into_iter().zip(z.partial)) {
            *d = u * *d + v * b + w * c;
        }
        Self {
            value: length,
            partial,
        }
    }

    #[inline(always)]
    fn lattice(lattice: Lattice, x: Self, y: Self, z: Self) -> Self {
        let [u, v, w] = N::lattice_slope(lattice, x.value, y.value, z.value);
        let mut partial = x.partial;
        for (d, (b, c)) in partial.iter_mut().zip(y.partial.into_iter().zip(z.partial)) {
            *d = u * *d + v * b + w * c;
        }
        Self {
            value: N::lattice(lattice, x.value, y.value, z.value),
            partial,
        }
    }

    #[inline(always)]
    fn mix(self, a: Self, b: Self) -> Self {
        let value = self.value.mix(a.value, b.value);
        let rise = b.value - a.value;
        let mut partial = a.partial;
        for (d, (db, dt)) in partial
            .iter_mut()
            .zip(b.partial.into_iter().zip(self.partial))
        {
            *d = self.value.mix(*d, db) + rise * dt;
        }
        Self { value, partial }
    }

    /// The slope 6 t (1 - t) as 3/2 - 6 (t - 1/2)^2, of which an interval gives the exact range.
    #[inline(always)]
    fn ease(self) -> Self {
        let from_middle = self.value - N::splat(0.5);
        let slope = N::splat(1.5) - N::splat(6.0) * from_middle.square();
        self.chain(self.value.ease(), slope)
    }

    #[inline(always)]
    fn square(self) -> Self {
        self.chain(self.value.square(), self.value + self.value)
    }
    /// Where the derivative by the base is infinite (a root at 0) it is defined as 0.
    #[inline(always)]
    fn pow(self, e: Self) -> Self {
        let (zero, infinity) = (N::splat(0.0), N::splat(f64::INFINITY));
        let value = self.value.pow(e.value);
        let slope = e.value * self.value.pow(e.value - N::splat(1.0));
        let growth = N::select_lt(zero, self.value, value * self.value.ln(), zero);
        self.zip(e, value, |dx, de| {
            N::select_lt(slope.abs(), infinity, slope * dx, zero) + growth * de
        })
    }

    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        if n == 0 {
            return Self::splat(1.0);
        }
        let slope = N::splat(n.into()) * self.value.powi(n.saturating_sub(1));
        self.chain(self.value.powi(n), slope)
    }

    #[inline(always)]
    fn tan(self) -> Self {
        let value = self.value.tan();
        self.chain(value, N::splat(1.0) + value.square())
    }

    #[inline(always)]
    fn asin(self) -> Self {
        self.chain_over(self.value.asin(), self.value.cathetus())
    }

    #[inline(always)]
    fn acos(self) -> Self {
        -self.chain_over(-self.value.acos(), self.value.cathetus())
    }
}

#[cfg(test)]
mod tests {
    use super::super::Interval;
    use super::super::interval::tests::{point_of, random_interval};
    use super::super::samples::{Samples, Tree, binary, unary};
    use super::*;
    use num_dual::{Dual64, DualNum};

    const SEED: u64 = 0xd0a1;
    const POINTS: usize = 2_000;

    type Dual1 = Dual<f64, 1>;
    type Dual3 = Dual<f64, 3>;
    type Range3 = Dual<Interval, 3>;

    /// The central difference of `f` at `x`; its error is `h^2 / 6` of the third derivative.
    fn difference(f: impl Fn(f64) -> f64, x: f64) -> f64 {
        let h = 1e-5;
        (f(x + h) - f(x - h)) / (2.0 * h)
    }

    fn assert_close(got: f64, expected: f64, tolerance: f64, about: &str) {
        let error = (got - expected).abs() / (1.0 + expected.abs());
        assert!(
            error <= tolerance,
            "{about}: {got:e}, expected {expected:e}, seed {SEED:#x}"
        );
    }

    #[test]
    fn derivatives_equal_central_differences() {
        let mut samples = Samples::new(SEED);
        for ((name, dual), (_, f)) in unary::<Dual1>().into_iter().zip(unary::<f64>()) {
            for _ in 0..POINTS {
                let x = samples.uniform(0.1, 0.9);
                let slope = dual(Dual::variable(x, 0)).partial[0];
                assert_close(slope, difference(f, x), 1e-6, &format!("{name} at {x:e}"));
            }
        }
    }

    #[test]
    fn gradients_equal_central_differences() {
        let mut samples = Samples::new(SEED);
        for ((name, dual), (_, f)) in binary::<Dual3>().into_iter().zip(binary::<f64>()) {
            for _ in 0..POINTS {
                let (x, y) = (samples.uniform(0.5, 2.0), samples.uniform(-2.0, 2.0));
                let is_near_kink = (x - y).abs() < 1e-4 || y.abs() < 1e-1;
                if is_near_kink {
                    continue;
                }
                let partial = dual(Dual::variable(x, 0), Dual::variable(y, 2)).partial;
                let about = format!("{name} at {x:e}, {y:e}");
                assert_close(partial[0], difference(|x| f(x, y), x), 1e-6, &about);
                assert_close(partial[1], 0.0, 0.0, &about);
                assert_close(partial[2], difference(|y| f(x, y), y), 1e-6, &about);
            }
        }
    }

    #[test]
    fn derivatives_equal_those_of_an_independent_crate() {
        type Pair = (&'static str, fn(Dual1) -> Dual1, fn(Dual64) -> Dual64);
        let pairs: [Pair; 13] = [
            ("sin", Number::sin, |x| DualNum::sin(&x)),
            ("cos", Number::cos, |x| DualNum::cos(&x)),
            ("tan", Number::tan, |x| DualNum::tan(&x)),
            ("asin", Number::asin, |x| DualNum::asin(&x)),
            ("acos", Number::acos, |x| DualNum::acos(&x)),
            ("exp", Number::exp, |x| DualNum::exp(&x)),
            ("ln", Number::ln, |x| DualNum::ln(&x)),
            ("sqrt", Number::sqrt, |x| DualNum::sqrt(&x)),
            ("powi", |x| x.powi(-3), |x| DualNum::powi(&x, -3)),
            (
                "pow",
                |x| x.pow(Dual1::splat(2.4)),
                |x| DualNum::powf(&x, 2.4),
            ),
            ("x^x", |x| x.pow(x), |x| DualNum::powd(&x, x)),
            (
                "atan2",
                |x| x.atan2(x.exp()),
                |x| DualNum::atan2(&x, DualNum::exp(&x)),
            ),
            (
                "composed",
                |x| (x.sin() * x.exp() - x / (x + x.cos())).square().hypot(x),
                |x| {
                    let y = DualNum::sin(&x) * DualNum::exp(&x) - x / (x + DualNum::cos(&x));
                    DualNum::sqrt(&(y * y * y * y + x * x))
                },
            ),
        ];
        let mut samples = Samples::new(SEED);
        for (name, ours, theirs) in pairs {
            for _ in 0..POINTS {
                let x = samples.uniform(0.01, 0.99);
                let ours = ours(Dual::variable(x, 0));
                let theirs = theirs(Dual64::from_re(x).derivative());
                let about = format!("{name} at {x:e}");
                assert_close(ours.value, theirs.re, 1e-13, &about);
                assert_close(ours.partial[0], theirs.eps, 1e-12, &about);
            }
        }
    }

    #[test]
    fn waves_found_together_have_the_slopes_of_each_alone() {
        let mut samples = Samples::new(SEED);
        for _ in 0..POINTS {
            let x = Dual1::variable(samples.uniform(-20.0, 20.0), 0);
            assert_eq!(x.sin_cos(), (x.sin(), x.cos()));
        }
    }

    #[test]
    fn length_of_a_clamped_vector_is_flat_inside() {
        for q in [-1.0, -1e-30, -0.0, 0.0] {
            let q = Dual1::variable(q, 0).max(Dual1::splat(0.0));
            assert_eq!((q * q).sqrt().partial, [0.0], "root of the square");
            assert_eq!(q.hypot(q).partial, [0.0], "hypot");
            assert_eq!(Dual1::norm3(q, q, q).partial, [0.0], "norm3");
        }
    }

    #[test]
    fn derivatives_at_singular_points_are_those_defined() {
        let at = |x: f64| Dual1::variable(x, 0);
        assert_eq!(
            [at(0.0).abs().partial, at(-2.0).abs().partial],
            [[1.0], [-1.0]]
        );
        assert_eq!(
            [at(1.0).asin().partial, at(-1.0).acos().partial],
            [[0.0]; 2]
        );
        assert_eq!(at(0.0).atan2(at(0.0)).partial, [0.0]);
        assert_eq!(at(0.0).pow(Dual::splat(0.5)).partial, [0.0]);
        assert_eq!(at(0.0).pow(Dual::splat(1.0)).partial, [1.0]);
        assert_eq!(at(0.0).pow(Dual::splat(2.0)).partial, [0.0]);
        assert_eq!(at(0.0).powi(0), Dual1::splat(1.0));
        assert_eq!(at(0.0).powi(1).partial, [1.0]);
        assert_eq!(at(-3.0).powi(2).partial, [-6.0]);
        assert_eq!(at(-3.0).powi(3).partial, [27.0]);
    }

    #[test]
    fn gradient_ranges_contain_gradients() {
        let mut samples = Samples::new(SEED);
        let (mut bounded, mut checked) = (0, 0);
        for round in 0..10 * POINTS {
            let tree = Tree::random(&mut samples, 1 + round % 4);
            let region = [0; 3].map(|_| random_interval(&mut samples));
            let range = tree.value([0, 1, 2].map(|i| Range3::variable(region[i], i)));
            bounded += usize::from(range.partial.iter().all(|d| d.magnitude() < f64::INFINITY));
            for _ in 0..5 {
                let p = region.map(|x| point_of(x, &mut samples));
                let at = [0, 1, 2].map(|i| Dual3::variable(p[i], i));
                if !tree.all_steps(at, is_finite) {
                    continue;
                }
                checked += 1;
                let gradient = tree.value(at).partial;
                for (range, d) in range.partial.into_iter().zip(gradient) {
                    assert!(
                        range.contains(d),
                        "{tree:?} at {p:?} in {region:?}: {d:e} in {range:?}, seed {SEED:#x}"
                    );
                }
            }
        }
        assert!(bounded > 5 * POINTS, "only {bounded} ranges are bounded");
        assert!(
            checked > 20 * POINTS,
            "only {checked} gradients were defined"
        );
    }

    fn is_finite(x: Dual3) -> bool {
        x.value.is_finite() && x.partial.into_iter().all(f64::is_finite)
    }

    #[test]
    fn gradient_range_of_a_kink_is_between_its_sides() {
        let x = Dual::<Interval, 1>::variable(Interval::new(-1.0, 2.0), 0);
        assert_eq!(x.abs().partial, [Interval::new(-1.0, 1.0)]);
        assert_eq!(x.max(Dual::splat(0.0)).partial, [Interval::new(0.0, 1.0)]);
        assert_eq!(x.hypot(x).partial[0].magnitude(), 2.0);
    }

    #[test]
    fn gradient_range_of_a_jump_is_unbounded() {
        let x = Dual::<Interval, 1>::variable(Interval::new(-0.5, 0.5), 0);
        let (zero, one) = (Dual::splat(0.0), Dual::splat(1.0));
        assert_eq!(x.floor().partial, [Interval::ENTIRE]);
        assert_eq!(x.atan2(-one).partial, [Interval::ENTIRE]);
        assert!(x.atan2(one).partial[0].magnitude() < 1.3);
        assert_eq!(Dual::select_lt(x, zero, x, one).partial, [Interval::ENTIRE]);
    }
}
