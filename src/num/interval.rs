//! Intervals: the range of a field over a region, rounded outwards.
//!
//! An operation gives an interval that holds the exact result, and the `f64` result, for all finite operands within its
//! arguments. Infinite ends mean unbounded. Where some operands have no result (the root of a negative number, zero by
//! zero) the answer is [`Interval::ENTIRE`], which also stands for "perhaps not a number"; the operations after it speak
//! for numbers only. A divisor 0 counts as positive, as squares, lengths and absolute values give it: 1 by [0, 1] is
//! [1, inf], 1 by [-1, 0] is everything.

use super::number::whole_power;
use super::{Lattice, Number, lattice_range};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// All numbers from `lo` to `hi`; never empty, no end is NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The lower end.
    pub lo: f64,
    /// The upper end.
    pub hi: f64,
}

/// Ends that come from an elementary function are moved outwards by so many steps. The kernels are off by at most 2 ulp:
/// twice that holds both the exact value and the kernel's at any point between the ends.
const KERNEL_STEPS: u32 = 4;

/// The same for functions composed of two kernels and a root (`tan`, `asin`, `acos`).
const COMPOSED_STEPS: u32 = 12;

/// `x` moved down by `steps` floating point numbers.
fn below(x: f64, steps: u32) -> f64 {
    (0..steps).fold(x, |x, _| x.next_down())
}

/// `x` moved up by `steps` floating point numbers.
fn above(x: f64, steps: u32) -> f64 {
    (0..steps).fold(x, |x, _| x.next_up())
}

/// What rounding took from the sum `s = a + b`, exactly (Knuth's two-sum); NaN where the sum overflows.
fn lost_in_sum(a: f64, b: f64, s: f64) -> f64 {
    let shadow = s - a;
    (a - (s - shadow)) + (b - shadow)
}

/// `a + b` rounded down; exact sums stay.
fn sum_down(a: f64, b: f64) -> f64 {
    let s = a + b;
    let lost = lost_in_sum(a, b, s);
    if lost >= 0.0 { s } else { s.next_down() }
}

/// `a + b` rounded up; exact sums stay.
fn sum_up(a: f64, b: f64) -> f64 {
    -sum_down(-a, -b)
}

/// The limit of products at `a` and `b`: an infinite end never meets zero itself, so 0 stays 0.
fn product(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

/// The limit of quotients at `a` and a `b` other than 0; finite by infinite is 0.
fn quotient(a: f64, b: f64) -> f64 {
    if b.is_infinite() { 0.0 } else { a / b }
}

/// Whether some whole number lies in `[a, b]`; also true where rounding leaves it open. The ends may be off by
/// three rounding errors.
fn may_hold_whole(a: f64, b: f64) -> bool {
    let slack = 2.0 * f64::EPSILON * (a.abs() + b.abs() + 1.0);
    let is_finite = slack.is_finite();
    !is_finite || (b + slack).floor() >= (a - slack).ceil()
}

impl Interval {
    /// All numbers, and "perhaps not a number".
    pub const ENTIRE: Self = Self {
        lo: f64::NEG_INFINITY,
        hi: f64::INFINITY,
    };

    /// The number 0.
    const ZERO: Self = Self { lo: 0.0, hi: 0.0 };

    /// The number 1.
    const ONE: Self = Self { lo: 1.0, hi: 1.0 };

    /// From the lesser to the greater of two ends, in whichever order; `ENTIRE` if one is NaN.
    pub fn new(lo: f64, hi: f64) -> Self {
        if lo <= hi {
            Self { lo, hi }
        } else if hi < lo {
            Self { lo: hi, hi: lo }
        } else {
            Self::ENTIRE
        }
    }

    /// The number `x` alone; `ENTIRE` if it is NaN.
    pub fn point(x: f64) -> Self {
        Self::new(x, x)
    }

    /// Whether `x` is one of the numbers. NaN counts as contained where the interval is `ENTIRE`.
    pub fn contains(self, x: f64) -> bool {
        self == Self::ENTIRE || self.lo <= x && x <= self.hi
    }

    /// The distance of the ends, rounded up.
    pub fn width(self) -> f64 {
        if self.lo == self.hi {
            0.0
        } else {
            sum_up(self.hi, -self.lo)
        }
    }

    /// A finite number about the middle; never outside.
    pub fn mid(self) -> f64 {
        let (lo, hi) = (self.lo.max(f64::MIN), self.hi.min(f64::MAX));
        (0.5 * lo + 0.5 * hi).max(lo).min(hi)
    }

    /// The smallest interval that contains both.
    pub fn hull(self, o: Self) -> Self {
        Self {
            lo: self.lo.min(o.lo),
            hi: self.hi.max(o.hi),
        }
    }

    /// The largest absolute value.
    pub fn magnitude(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }

    /// The smallest absolute value.
    pub fn mignitude(self) -> f64 {
        if self.lo <= 0.0 && self.hi >= 0.0 {
            0.0
        } else {
            self.lo.abs().min(self.hi.abs())
        }
    }

    /// The ends moved outwards by `steps` numbers, but not out of `[low, high]`.
    fn widened(self, steps: u32, low: f64, high: f64) -> Self {
        Self::new(
            below(self.lo, steps).max(low),
            above(self.hi, steps).min(high),
        )
    }

    /// The smallest interval around the `ends`, one rounding error wider; on one side of 0 if `signs` multiply so.
    fn rounded(ends: [f64; 4], (a, b): (Self, Self)) -> Self {
        let lo = ends.into_iter().fold(f64::INFINITY, f64::min);
        let hi = ends.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let is_same_sign = a.lo >= 0.0 && b.lo >= 0.0 || a.hi <= 0.0 && b.hi <= 0.0;
        let is_opposite = a.lo >= 0.0 && b.hi <= 0.0 || a.hi <= 0.0 && b.lo >= 0.0;
        let low = if is_same_sign { 0.0 } else { f64::NEG_INFINITY };
        let high = if is_opposite { 0.0 } else { f64::INFINITY };
        Self { lo, hi }.widened(1, low, high)
    }

    /// The monotone function `f` of all numbers, off by at most `steps` numbers, with values in `[low, high]`.
    fn monotone(self, f: impl Fn(f64) -> f64, steps: u32, low: f64, high: f64) -> Self {
        Self::new(f(self.lo), f(self.hi)).widened(steps, low, high)
    }

    /// A function of period 2 pi with values in [-1, 1], `f` at the ends, that is 1 at `peak` turns and -1 half a turn on.
    fn wave(self, f: impl Fn(f64) -> f64, peak: f64) -> Self {
        let (a, b) = (self.lo / TAU - peak, self.hi / TAU - peak);
        let has_peak = may_hold_whole(a, b);
        let has_trough = may_hold_whole(a - 0.5, b - 0.5);
        if has_peak && has_trough {
            return Self::new(-1.0, 1.0);
        }
        let ends = Self::new(f(self.lo), f(self.hi)).widened(KERNEL_STEPS, -1.0, 1.0);
        Self {
            lo: if has_trough { -1.0 } else { ends.lo },
            hi: if has_peak { 1.0 } else { ends.hi },
        }
    }

    /// The greatest `c / length` with `c` in `self`, where no `|c|` exceeds its length; 0 where the length is 0.
    fn greatest_cosine(self, length: Self) -> f64 {
        let c = self.hi;
        if c <= 0.0 {
            let top = quotient(c, length.hi.max(f64::MIN_POSITIVE));
            // The length of a tiny vector may underflow to 0.
            return if length.lo > 0.0 {
                top.next_up().min(0.0)
            } else {
                0.0
            };
        }
        quotient(c, length.lo).next_up().min(1.0)
    }
}

impl Add for Interval {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self::new(sum_down(self.lo, o.lo), sum_up(self.hi, o.hi))
    }
}

impl Sub for Interval {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul for Interval {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        if self == Self::ZERO || o == Self::ZERO {
            return Self::ZERO;
        }
        if self == Self::ONE {
            return o;
        }
        if o == Self::ONE {
            return self;
        }
        let ends = [
            product(self.lo, o.lo),
            product(self.lo, o.hi),
            product(self.hi, o.lo),
            product(self.hi, o.hi),
        ];
        Self::rounded(ends, (self, o))
    }
}

impl Div for Interval {
    type Output = Self;

    /// A divisor that reaches down to 0 gives a half-line; one that reaches up to 0, or around it, gives everything.
    fn div(self, o: Self) -> Self {
        if o == Self::ONE {
            return self;
        }
        if o.hi < 0.0 {
            return -self / -o;
        }
        if o.lo < 0.0 || o.hi <= 0.0 || o.lo == f64::INFINITY {
            return Self::ENTIRE;
        }
        if o.lo == 0.0 {
            return self.over_up_to(o.hi);
        }
        if self == Self::ZERO {
            return Self::ZERO;
        }
        let ends = [
            quotient(self.lo, o.lo),
            quotient(self.lo, o.hi),
            quotient(self.hi, o.lo),
            quotient(self.hi, o.hi),
        ];
        Self::rounded(ends, (self, o))
    }
}

impl Interval {
    /// `self^n`: monotone on each side of 0, so the extremes are at the ends, and at 0 for even powers.
    fn whole_power(self, n: u32) -> Self {
        let ends = if n.is_multiple_of(2) {
            self.abs()
        } else {
            self
        };
        let [low, high] = [ends.lo, ends.hi].map(|x| whole_power(Self::point(x), n));
        low.hull(high)
    }

    /// `self` by all numbers of (0, b].
    fn over_up_to(self, b: f64) -> Self {
        if self.lo > 0.0 {
            Self::new(quotient(self.lo, b).next_down().max(0.0), f64::INFINITY)
        } else if self.hi < 0.0 {
            Self::new(f64::NEG_INFINITY, quotient(self.hi, b).next_up().min(0.0))
        } else {
            Self::ENTIRE
        }
    }
}

impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            lo: -self.hi,
            hi: -self.lo,
        }
    }
}

impl Number for Interval {
    type Constant = f64;

    fn constant(x: f64) -> f64 {
        x
    }

    fn spread(x: f64) -> Self {
        Self::point(x)
    }

    fn min(self, o: Self) -> Self {
        Self {
            lo: self.lo.min(o.lo),
            hi: self.hi.min(o.hi),
        }
    }

    fn max(self, o: Self) -> Self {
        Self {
            lo: self.lo.max(o.lo),
            hi: self.hi.max(o.hi),
        }
    }

    fn abs(self) -> Self {
        Self {
            lo: self.mignitude(),
            hi: self.magnitude(),
        }
    }

    fn sqrt(self) -> Self {
        if self.lo < 0.0 {
            return Self::ENTIRE;
        }
        let root = |x: f64, round: fn(f64) -> f64| if x == 0.0 { 0.0 } else { round(x.sqrt()) };
        Self {
            lo: root(self.lo, f64::next_down),
            hi: root(self.hi, f64::next_up),
        }
    }

    fn floor(self) -> Self {
        Self {
            lo: self.lo.floor(),
            hi: self.hi.floor(),
        }
    }

    fn sin(self) -> Self {
        self.wave(Number::sin, 0.25)
    }

    fn cos(self) -> Self {
        self.wave(Number::cos, 0.0)
    }

    /// Tight where the box does not cross the negative x axis; there [-pi, pi].
    fn atan2(self, x: Self) -> Self {
        let full = Self::new(-PI.next_up(), PI.next_up());
        if crosses_cut(self, x) {
            return full;
        }
        // The angle turns one way along every side of the box: its extremes are at corners.
        let sides = [
            (self.lo, x.lo),
            (self.lo, x.hi),
            (self.hi, x.lo),
            (self.hi, x.hi),
        ];
        let corners = sides.map(|(y, x)| Self::point(Number::atan2(y, x)));
        let [a, b, c, d] = corners;
        a.hull(b)
            .hull(c)
            .hull(d)
            .widened(KERNEL_STEPS, full.lo, full.hi)
    }

    fn exp(self) -> Self {
        self.monotone(Number::exp, KERNEL_STEPS, 0.0, f64::INFINITY)
    }

    fn ln(self) -> Self {
        if self.lo < 0.0 {
            return Self::ENTIRE;
        }
        self.monotone(Number::ln, KERNEL_STEPS, f64::NEG_INFINITY, f64::INFINITY)
    }

    fn select_lt(a: Self, b: Self, x: Self, y: Self) -> Self {
        if a.hi < b.lo {
            x
        } else if a.lo >= b.hi {
            y
        } else {
            x.hull(y)
        }
    }

    fn select_lt_slope(a: Self, b: Self, x: Self, y: Self) -> Self {
        if a.hi < b.lo {
            x
        } else if a.lo >= b.hi {
            y
        } else {
            Self::ENTIRE
        }
    }

    fn floor_slope(self) -> Self {
        if self.lo.floor() == self.hi.floor() {
            Self::ZERO
        } else {
            Self::ENTIRE
        }
    }

    /// For a share within [0, 1] it rises with both ends, and its extremes lie at the ends of the share.
    fn mix(self, a: Self, b: Self) -> Self {
        if self.lo < 0.0 || self.hi > 1.0 {
            return a + (b - a) * self;
        }
        let [t, s] = [self.lo, self.hi].map(Self::point);
        let between = |a: f64, b: f64| {
            let (a, b) = (Self::point(a), Self::point(b));
            (a + (b - a) * t).hull(a + (b - a) * s)
        };
        let (low, high) = (between(a.lo, b.lo), between(a.hi, b.hi));
        // Numbers are computed with three roundings of values up to |a| + |b|, which may cancel.
        let noise = 4.0 * f64::EPSILON * (a.magnitude() + b.magnitude());
        Self::new((low.lo - noise).next_down(), (high.hi + noise).next_up())
    }

    /// It rises on [0, 1].
    fn ease(self) -> Self {
        let cubic = |t: Self| t.square() * (Self::point(3.0) - t - t);
        if self.lo < 0.0 || self.hi > 1.0 {
            return cubic(self);
        }
        let (low, high) = (cubic(Self::point(self.lo)), cubic(Self::point(self.hi)));
        Self {
            lo: low.lo.max(0.0),
            hi: high.hi,
        }
    }

    fn square(self) -> Self {
        let (near, far) = (self.abs().lo, self.abs().hi);
        let square = |x: f64, round: fn(f64) -> f64| if x == 0.0 { 0.0 } else { round(x * x) };
        Self {
            lo: square(near, f64::next_down).max(0.0),
            hi: square(far, f64::next_up),
        }
    }

    fn pow(self, e: Self) -> Self {
        if self.lo < 0.0 {
            return Self::ENTIRE;
        }
        (e * self.ln()).exp()
    }

    fn powi(self, n: i32) -> Self {
        let power = self.whole_power(n.unsigned_abs());
        if n < 0 { Self::ONE / power } else { power }
    }

    /// Everything where a pole may lie inside.
    fn tan(self) -> Self {
        if may_hold_whole(self.lo / PI - 0.5, self.hi / PI - 0.5) {
            return Self::ENTIRE;
        }
        self.monotone(
            Number::tan,
            COMPOSED_STEPS,
            f64::NEG_INFINITY,
            f64::INFINITY,
        )
    }

    fn asin(self) -> Self {
        if self.magnitude() > 1.0 {
            return Self::ENTIRE;
        }
        let limit = FRAC_PI_2.next_up();
        self.monotone(Number::asin, COMPOSED_STEPS, -limit, limit)
    }

    fn acos(self) -> Self {
        if self.magnitude() > 1.0 {
            return Self::ENTIRE;
        }
        self.monotone(Number::acos, COMPOSED_STEPS, 0.0, PI.next_up())
    }

    fn cathetus(self) -> Self {
        if self.magnitude() > 1.0 {
            return Self::ENTIRE;
        }
        self.abs()
            .monotone(Number::cathetus, KERNEL_STEPS, 0.0, 1.0)
    }

    fn fract(self) -> Self {
        let floor = self.floor();
        let fract = if floor.lo == floor.hi {
            self - floor
        } else {
            Self { lo: 0.0, hi: 1.0 }
        };
        Self {
            lo: fract.lo.max(0.0),
            hi: fract.hi.min(1.0),
        }
    }

    fn lattice(lattice: Lattice, x: Self, y: Self, z: Self) -> Self {
        lattice_range::value(lattice, [x, y, z])
    }

    fn lattice_slope(lattice: Lattice, x: Self, y: Self, z: Self) -> [Self; 3] {
        lattice_range::slope(lattice, [x, y, z])
    }

    fn atan2_slope(self, x: Self, slope: Self) -> Self {
        if crosses_cut(self, x) {
            Self::ENTIRE
        } else {
            slope
        }
    }

    /// Uses that no component exceeds the length: within [-1, 1] even where the length may be 0.
    fn direction_cosine(self, length: Self) -> Self {
        if length.hi <= 0.0 {
            return Self::ZERO;
        }
        Self {
            lo: -(-self).greatest_cosine(length),
            hi: self.greatest_cosine(length),
        }
    }
}

/// Whether points of the box lie on both sides of the cut of `atan2`, the negative x axis.
fn crosses_cut(y: Interval, x: Interval) -> bool {
    x.lo < 0.0 && y.lo < 0.0 && y.hi >= 0.0
}

#[cfg(test)]
pub mod tests {
    use super::super::samples::{Samples, Tree, binary, unary};
    use super::*;

    const SEED: u64 = 0x17e5;
    const BOXES: usize = 20_000;

    /// An interval of any size from a point upwards, about the origin or away from it.
    pub fn random_interval(samples: &mut Samples) -> Interval {
        let center = if samples.below(4) == 0 {
            0.0
        } else {
            samples.scaled(-6.0, 6.0)
        };
        let radius = match samples.below(5) {
            0 => 0.0,
            // One end is 0.
            4 => center,
            1 => samples.scaled(-7.0, 1.0) * center,
            _ => samples.scaled(-6.0, 2.0),
        };
        Interval::new(center - radius, center + radius)
    }

    /// An end, zero or one where possible, else any point.
    pub fn point_of(x: Interval, samples: &mut Samples) -> f64 {
        let special = [x.lo, x.hi, 0.0, 1.0, -1.0, x.mid()][samples.below(6)];
        if samples.bits() & 1 == 0 && x.contains(special) {
            special
        } else {
            samples.uniform(x.lo, x.hi).clamp(x.lo, x.hi)
        }
    }

    #[test]
    fn functions_of_one_interval_contain_their_values() {
        let mut samples = Samples::new(SEED);
        for ((name, range), (_, value)) in unary::<Interval>().into_iter().zip(unary::<f64>()) {
            for _ in 0..BOXES {
                let x = random_interval(&mut samples);
                for _ in 0..5 {
                    let p = point_of(x, &mut samples);
                    let (range, value) = (range(x), value(p));
                    assert!(
                        range.contains(value),
                        "{name} of {p:e} in {x:?}: {value:e} in {range:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn functions_of_two_intervals_contain_their_values() {
        let mut samples = Samples::new(SEED);
        for ((name, range), (_, value)) in binary::<Interval>().into_iter().zip(binary::<f64>()) {
            for _ in 0..BOXES {
                let [x, y] = [0; 2].map(|_| random_interval(&mut samples));
                for _ in 0..5 {
                    let [p, q] = [x, y].map(|x| point_of(x, &mut samples));
                    let (range, value) = (range(x, y), value(p, q));
                    assert!(
                        range.contains(value),
                        "{name} of {p:e}, {q:e} in {x:?}, {y:?}: {value:e} in {range:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn expressions_contain_their_values() {
        let mut samples = Samples::new(SEED);
        let (mut bounded, mut checked) = (0, 0);
        for _ in 0..BOXES {
            let tree = Tree::random(&mut samples, 4);
            let at = [0; 3].map(|_| random_interval(&mut samples));
            let range = tree.value(at);
            bounded += usize::from(range != Interval::ENTIRE);
            for _ in 0..5 {
                let p = at.map(|x| point_of(x, &mut samples));
                let value: f64 = tree.value(p);
                let is_defined = tree.all_steps(p, f64::is_finite);
                checked += usize::from(is_defined);
                let holds = range.contains(value) || !is_defined;
                assert!(holds, "{tree:?} at {p:?} in {at:?}: {value:e} in {range:?}");
            }
        }
        assert!(bounded > BOXES / 3, "only {bounded} ranges say anything");
        assert!(checked > BOXES, "only {checked} values were defined");
    }

    #[test]
    fn elementary_functions_contain_the_values_of_libm() {
        type Pair = (fn(Interval) -> Interval, fn(f64) -> f64);
        let pairs: [Pair; 7] = [
            (Number::sin, libm::sin),
            (Number::cos, libm::cos),
            (Number::tan, libm::tan),
            (Number::exp, libm::exp),
            (Number::ln, libm::log),
            (Number::asin, libm::asin),
            (Number::acos, libm::acos),
        ];
        let mut samples = Samples::new(SEED);
        for _ in 0..BOXES {
            let x = random_interval(&mut samples);
            let p = point_of(x, &mut samples);
            for (range, value) in pairs {
                let (range, value) = (range(x), value(p));
                assert!(
                    range.contains(value),
                    "{p:e} in {x:?}: {value:e} in {range:?}"
                );
            }
        }
    }

    #[test]
    fn ranges_are_tight() {
        let interval = Interval::new;
        let cases = [
            (interval(-1.0, 2.0).square(), 0.0, 4.0),
            (interval(-1.0, 2.0).powi(3), -1.0, 8.0),
            (interval(-1.0, 2.0).powi(4), 0.0, 16.0),
            (interval(0.0, 4.0).sin(), -0.756_802_495_307_928_3, 1.0),
            (interval(2.0, 4.0).cos(), -1.0, -0.416_146_836_547_142_4),
            (
                Number::hypot(interval(3.0, 6.0), interval(-4.0, 8.0)),
                3.0,
                10.0,
            ),
            (
                interval(1.0, 2.0).atan2(interval(-1.0, 1.0)),
                PI / 4.0,
                3.0 * PI / 4.0,
            ),
            (interval(0.0, 2.0).pow(Interval::point(2.0)), 0.0, 4.0),
            (interval(4.0, 9.0).pow(Interval::point(0.5)), 2.0, 3.0),
            (Interval::ONE / interval(0.0, 2.0), 0.5, f64::INFINITY),
            (
                interval(1.0, 2.0).direction_cosine(interval(4.0, 8.0)),
                0.125,
                0.5,
            ),
            (
                interval(-1.0, 5.0).direction_cosine(interval(0.0, 8.0)),
                -1.0,
                1.0,
            ),
            (interval(1.25, 1.5).fract(), 0.25, 0.5),
            (interval(-0.5, 0.5).asin(), -PI / 6.0, PI / 6.0),
            (interval(-1.0, 0.5).cathetus(), 0.0, 1.0),
        ];
        for (i, (range, lo, hi)) in cases.into_iter().enumerate() {
            let slack = 1e-14;
            assert!(range.lo <= lo && range.hi >= hi, "case {i}: {range:?}");
            assert!(
                range.lo >= lo - slack && (range.hi <= hi + slack),
                "case {i}: {range:?}"
            );
        }
    }

    #[test]
    fn sums_are_rounded_only_where_they_must_be() {
        let point = Interval::point;
        assert_eq!(point(1.0) + point(2.0), point(3.0));
        assert_eq!(point(0.0) + point(0.0), point(0.0));
        let third = point(0.1) + point(0.2);
        assert_eq!(third.lo.next_up(), third.hi);
        // 0.1 + 0.2 in exact arithmetic on the two doubles: 0.3000000000000000166533453694.
        assert!(third.lo == 0.3 && third.hi == 0.30000000000000004);
    }

    /// The sign of what rounding took from each operation, by fused multiply-add; the ends must lie on that side.
    #[test]
    fn ends_enclose_exact_results() {
        let mut samples = Samples::new(SEED);
        let point = Interval::point;
        for _ in 0..BOXES {
            let [a, b] = [0; 2].map(|_| samples.scaled(-6.0, 6.0));
            let (p, q, r, s) = (a * b, a / b, a.abs().sqrt(), a + b);
            let lost_in_sum = if a.abs() > b.abs() {
                b - (s - a)
            } else {
                a - (s - b)
            };
            let cases = [
                (point(a) * point(b), p, a.mul_add(b, -p)),
                (point(a).square(), a * a, a.mul_add(a, -(a * a))),
                (point(a) / point(b), q, (-q).mul_add(b, a) * b.signum()),
                (point(a.abs()).sqrt(), r, (-r).mul_add(r, a.abs())),
                (point(a) + point(b), s, lost_in_sum),
            ];
            for (i, (range, rounded, lost)) in cases.into_iter().enumerate() {
                assert!(range.contains(rounded), "case {i} of {a:e}, {b:e}");
                assert!(
                    lost >= 0.0 || range.lo < rounded,
                    "case {i} of {a:e}, {b:e}"
                );
                assert!(
                    lost <= 0.0 || range.hi > rounded,
                    "case {i} of {a:e}, {b:e}"
                );
            }
        }
    }

    #[test]
    fn what_cannot_be_negative_is_not() {
        let tiny = Interval::point(1e-200);
        assert_eq!(tiny.square().lo, 0.0);
        assert_eq!((tiny * tiny).lo, 0.0);
        assert_eq!((tiny / Interval::point(1e200)).lo, 0.0);
        assert_eq!(Interval::new(-1.0, 1.0).hypot(tiny).lo, 0.0);
        assert_eq!(Interval::point(-1e9).exp().lo, 0.0);
    }

    #[test]
    fn direction_of_a_vanishing_vector_may_be_zero() {
        let c = Interval::point(-1e-200);
        assert!(c.direction_cosine(c.hypot(c)).contains(0.0));
        assert_eq!(
            Interval::ZERO.direction_cosine(Interval::ZERO),
            Interval::ZERO
        );
    }

    #[test]
    fn infinite_ends_never_meet_zero() {
        let (zero, infinity) = (Interval::point(0.0), Interval::point(f64::INFINITY));
        assert_eq!(zero * Interval::ENTIRE, zero);
        assert!((Interval::new(0.0, 1.0) * infinity).contains(0.0));
        assert!((infinity / Interval::new(1.0, f64::INFINITY)).contains(0.0));
        assert_eq!(
            Interval::new(0.0, 1.0) * Interval::new(1.0, f64::INFINITY),
            Interval::new(0.0, f64::INFINITY)
        );
        let ratio = Interval::new(1.0, f64::INFINITY) / Interval::new(1.0, f64::INFINITY);
        assert_eq!(ratio, Interval::new(0.0, f64::INFINITY));
    }

    #[test]
    fn undefined_results_are_everything() {
        let interval = Interval::new;
        let undefined = [
            interval(-1.0, 1.0).sqrt(),
            interval(-1.0, 1.0).ln(),
            interval(-1.0, 1.0) / interval(-1.0, 1.0),
            interval(0.0, 0.0) / interval(0.0, 0.0),
            interval(-2.0, 0.0).asin(),
            interval(1.0, 2.0).tan(),
            Interval::ENTIRE - Interval::ENTIRE,
            interval(f64::NAN, 1.0),
            interval(-1.0, 2.0).pow(Interval::point(0.5)),
        ];
        for (i, range) in undefined.into_iter().enumerate() {
            assert_eq!(range, Interval::ENTIRE, "case {i}");
        }
    }

    #[test]
    fn selection_joins_what_it_cannot_decide() {
        let interval = Interval::new;
        let [a, b, x, y] =
            [(0.0, 2.0), (1.0, 3.0), (5.0, 6.0), (8.0, 9.0)].map(|(lo, hi)| interval(lo, hi));
        assert_eq!(Interval::select_lt(a, b, x, y), interval(5.0, 9.0));
        assert_eq!(Interval::select_lt_slope(a, b, x, y), Interval::ENTIRE);
        assert_eq!(Interval::select_lt(a, x, x, y), x);
        assert_eq!(Interval::select_lt_slope(x, a, x, y), y);
        // Equal is not less.
        let one = Interval::point(1.0);
        assert_eq!(Interval::select_lt(one, one, x, y), y);
    }

    #[test]
    fn measures_of_an_interval() {
        let x = Interval::new(2.0, -6.0);
        assert_eq!((x.lo, x.hi, x.width(), x.mid()), (-6.0, 2.0, 8.0, -2.0));
        assert_eq!((x.magnitude(), x.mignitude()), (6.0, 0.0));
        assert_eq!(x.hull(Interval::point(3.0)), Interval::new(-6.0, 3.0));
        assert!(x.contains(2.0) && !x.contains(2.5) && !x.contains(f64::NAN));
        assert!(Interval::ENTIRE.contains(f64::NAN) && Interval::ENTIRE.mid() == 0.0);
        assert_eq!(Interval::point(5e-324).mid(), 5e-324);
    }
}
