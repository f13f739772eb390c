//! Ranges with bends: between which numbers the second derivative of a field lies, along every straight line through a
//! region.
//!
//! A field with the bends `[low, high]` is, along any line in any direction `u` of length 1, at the place `s` a convex
//! function plus `low s^2 / 2`, and a concave one plus `high s^2 / 2`. So kinks have bends too: |x| is convex and has
//! the bends [0, inf]. For steps along a ray: `f(s) >= f(0) + f'(0) s + low s^2 / 2`.
//!
//! The rules are those for second derivatives, with the slopes of [`Steep`]. They hold for kinks because the
//! second derivative of such a field is a bounded function plus a measure of one sign, for which the product rule and the
//! chain rule with smooth functions hold as well. Of smooth fields more is known: quadratic forms between which the second
//! derivatives lie, which tell directions apart.

mod form;
mod functions;
#[cfg(test)]
mod tests;

use super::steep::{dot, length, norm, times};
use super::{Interval, Number, Steep};
use form::{Forms, Wave};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The range of a field over a convex region, its slopes, and its bends: its second derivatives along straight lines.
#[derive(Clone, Copy, Debug)]
pub struct Bent {
    steep: Steep,
    bend: Interval,
    /// Between which forms the second derivatives lie; none where that is not known.
    forms: Option<Forms>,
    /// The field as a wave, if it is one.
    wave: Option<Wave>,
}

const ZERO: Interval = Interval { lo: 0.0, hi: 0.0 };

/// What both intervals hold; the first where rounding leaves nothing in common.
fn common(a: Interval, b: Interval) -> Interval {
    let (lo, hi) = (a.lo.max(b.lo), a.hi.min(b.hi));
    if lo <= hi { Interval { lo, hi } } else { a }
}

/// All numbers that are at most this far from 0.
fn around_zero(most: f64) -> Interval {
    Interval::new(-most, most)
}

/// How far a part of a vector, with values `range`, can pull the length of the vector down by its bends: only their lower
/// end does where it is positive.
fn pull_down(range: Interval, bend: Interval) -> f64 {
    let by_positive = (-bend.lo).max(0.0);
    let by_negative = bend.hi.max(0.0);
    if range.lo >= 0.0 {
        by_positive
    } else if range.hi <= 0.0 {
        by_negative
    } else {
        by_positive.max(by_negative)
    }
}

impl Bent {
    /// The coordinate number `index` over the interval.
    pub fn variable(range: Interval, index: usize) -> Self {
        Self::new(Steep::variable(range, index), ZERO).with(Some(Forms::ZERO))
    }

    /// The range of the value, with the slopes.
    pub fn steep(&self) -> Steep {
        self.steep
    }

    /// The least second derivative: -infinity where nothing is known.
    pub fn low(&self) -> f64 {
        self.bend.lo
    }

    /// The largest second derivative: infinity where nothing is known.
    pub fn high(&self) -> f64 {
        self.bend.hi
    }

    /// A field without any slope is a constant.
    fn new(steep: Steep, bend: Interval) -> Self {
        let is_constant = steep.slope() == 0.0;
        let bend = if is_constant { ZERO } else { bend };
        Self {
            steep,
            bend,
            forms: is_constant.then_some(Forms::ZERO),
            wave: None,
        }
    }

    /// With these forms, which may say more than the bends.
    fn with(self, forms: Option<Forms>) -> Self {
        if self.is_constant() {
            return self;
        }
        let by_forms = forms.as_ref().map_or(Interval::ENTIRE, Forms::bend);
        Self {
            bend: common(self.bend, by_forms),
            forms,
            ..self
        }
    }

    fn is_constant(&self) -> bool {
        self.steep.slope() == 0.0
    }

    /// What may jump.
    fn unknown(steep: Steep) -> Self {
        Self::new(steep, Interval::ENTIRE)
    }

    fn value(&self) -> Interval {
        self.steep.value()
    }

    /// What squares of the derivative along a line can be.
    fn squares(&self) -> Interval {
        let slope = self.steep.slope();
        Interval::new(0.0, times(slope, slope))
    }

    /// A smooth function of one number that was evaluated as `steep`, with the ranges of its first and second
    /// derivative: f(a)'' = f''(a) a'^2 + f'(a) a''.
    fn smooth(self, steep: Steep, first: Interval, second: Interval) -> Self {
        // Everything stands for "perhaps not a number" too.
        if steep.value() == Interval::ENTIRE {
            return Self::unknown(steep);
        }
        let carried = self.forms.and_then(|forms| forms.times(first));
        let own = Forms::of_squares(&self.steep, second);
        let forms = carried.zip(own).and_then(|(a, b)| a.plus(b));
        Self::new(steep, second * self.squares() + first * self.bend).with(forms)
    }

    /// A sine or a cosine, as [`Bent::smooth`].
    fn wave(self, steep: Steep, first: Interval, second: Interval) -> Self {
        let is_straight = self.forms.is_some_and(|forms| forms.are_zero());
        Self {
            wave: is_straight.then(|| Wave::of(&self.steep)),
            ..self.smooth(steep, first, second)
        }
    }

    /// A length that was evaluated as `steep`, of a vector q with unit vector e. Its second derivative is
    /// `(|q'|^2 - (e.q')^2) / |q| + e.q''`, of which the first part is not negative. The bound by the length of the bends
    /// holds at the origin too, where the length is the largest of all products with unit vectors, and those are bent
    /// no less.
    fn length<const N: usize>(steep: Steep, parts: [Self; N]) -> Self {
        let whole = steep.value();
        let down = length(parts.map(|q| pull_down(q.value(), q.bend)));
        let up = length(parts.map(|q| pull_down(q.value(), -q.bend)));
        let by_length = Interval::new(-down, up);
        if whole.lo <= 0.0 {
            let bend = Interval {
                lo: by_length.lo,
                hi: f64::INFINITY,
            };
            return Self::new(steep, bend);
        }
        let pulled = parts.into_iter().fold(ZERO, |sum, q| {
            sum + q.value().direction_cosine(whole) * q.bend
        });
        let steepest = norm(&parts.map(|q| q.steep));
        let across = Interval::new(0.0, times(steepest, steepest)) / Interval::point(whole.lo);
        Self::new(steep, common(by_length, pulled) + across)
    }
}

/// Twice the product of the derivatives of two fields along a line: with gradients g and h and a direction u,
/// `2 (g.u) (h.u)` is at least `g.h - |g| |h|` and at most `g.h + |g| |h|`.
fn crossed(a: &Steep, b: &Steep) -> Interval {
    let most = times(a.slope(), b.slope());
    common(around_zero(times(2.0, most)), dot(a, b) + around_zero(most))
}

impl Add for Bent {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        let forms = self.forms.zip(o.forms).and_then(|(a, b)| a.plus(b));
        Self::new(self.steep + o.steep, self.bend + o.bend).with(forms)
    }
}

impl Sub for Bent {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        let forms = self.forms.zip(o.forms);
        let forms = forms.and_then(|(a, b)| a.plus(b.opposite()));
        Self::new(self.steep - o.steep, self.bend - o.bend).with(forms)
    }
}

impl Mul for Bent {
    type Output = Self;

    /// (a b)'' = a b'' + b a'' + 2 a' b'.
    fn mul(self, o: Self) -> Self {
        let bends = self.value() * o.bend + o.value() * self.bend;
        let crossed = crossed(&self.steep, &o.steep);
        let parts = [
            o.forms.and_then(|forms| forms.times(self.value())),
            self.forms.and_then(|forms| forms.times(o.value())),
            Forms::crossed(&self.steep, &o.steep, crossed),
        ];
        let by_rule = parts.into_iter().reduce(|a, b| a?.plus(b?)).flatten();
        let waves = self.wave.zip(o.wave);
        let by_waves = waves.and_then(|(a, b)| a.product(b));
        let forms = [by_rule, by_waves].into_iter().flatten();
        let product = Self::new(self.steep * o.steep, bends + crossed);
        Self {
            wave: match [self.is_constant(), o.is_constant()] {
                [false, true] => self.wave.map(|wave| wave.times(o.value())),
                [true, false] => o.wave.map(|wave| wave.times(self.value())),
                _ => None,
            },
            ..product.with(forms.reduce(Forms::closer))
        }
    }
}

impl Div for Bent {
    type Output = Self;

    /// From a = q b follows q'' = (a'' - q b'' - 2 q' b') / b; and q is a product with 1 / b. Both count.
    fn div(self, o: Self) -> Self {
        let steep = self.steep / o.steep;
        let divisor = o.value();
        if divisor.contains(0.0) {
            return Self::unknown(steep);
        }
        let rest = self.bend - steep.value() * o.bend - crossed(&steep, &o.steep);
        let product = self * o.reciprocal();
        let quotient = Self::new(steep, common(rest / divisor, product.bend));
        Self {
            wave: product.wave,
            ..quotient.with(product.forms)
        }
    }
}

impl Neg for Bent {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            steep: -self.steep,
            bend: -self.bend,
            forms: self.forms.map(Forms::opposite),
            wave: self.wave,
        }
    }
}
