//! Quadratic forms between which the second derivatives of a field lie, in all directions at once.
//!
//! A number for all directions says too much of a sum: the bends of `sin x` and of `sin y` are at most 1, and so is that of
//! their sum along any line, but numbers add up to 2. Forms know the directions. They are ordered as Loewner did: one is
//! below another if it is so in every direction. They are known of smooth fields alone; at kinks numbers are what is left.

use crate::num::steep::length;
use crate::num::{Interval, Steep};
use std::ops::{Add, Neg, Sub};

/// A symmetric matrix: its diagonal, and its entries xy, xz and yz.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form([f64; 6]);

/// What rounding adds, as a share of the largest entry: each matrix is computed in fewer than ten roundings.
const ROOM: f64 = 1e-14;

impl Form {
    const ZERO: Self = Self([0.0; 6]);

    /// The form that is so much in every direction.
    fn all(by: f64) -> Self {
        Self([by, by, by, 0.0, 0.0, 0.0])
    }

    /// The form `2 (a.u) (b.u)` of the direction u.
    fn crossed(a: [f64; 3], b: [f64; 3]) -> Self {
        let entry = |i: usize, j: usize| a[i] * b[j] + a[j] * b[i];
        Self([(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|(i, j)| entry(i, j)))
    }

    fn times(self, by: f64) -> Self {
        Self(self.0.map(|entry| entry * by))
    }

    fn largest_entry(self) -> f64 {
        self.0.into_iter().map(f64::abs).fold(0.0, f64::max)
    }

    /// With room for rounding.
    fn up(self) -> Self {
        self + Self::all(ROOM * self.largest_entry())
    }

    fn trace(self) -> f64 {
        let [x, y, z, ..] = self.0;
        x + y + z
    }

    /// At least the most that it is in any direction: after some of Jacobi's rotations, by Gershgorin's circles.
    fn most(self) -> f64 {
        let [x, y, z, xy, xz, yz] = self.0;
        let mut rows = [[x, xy, xz], [xy, y, yz], [xz, yz, z]];
        for _ in 0..4 {
            for (i, j) in [(0, 1), (0, 2), (1, 2)] {
                rotate(&mut rows, i, j);
            }
        }
        let circle = |i: usize| -> f64 {
            let others = (0..3).filter(|j| *j != i).map(|j| rows[i][j].abs());
            rows[i][i] + others.sum::<f64>()
        };
        let most = circle(0).max(circle(1)).max(circle(2));
        most + ROOM * self.largest_entry()
    }

    /// A form above both: the larger one, if one is, else their mean and what the rows of half of their difference add up to.
    fn join(self, o: Self) -> Self {
        let difference = o - self;
        let room = ROOM * (self.largest_entry() + o.largest_entry());
        if difference.most() <= room {
            return self + Self::all(room);
        }
        if (-difference).most() <= room {
            return o + Self::all(room);
        }
        let [x, y, z, xy, xz, yz] = difference.0.map(|entry| 0.5 * entry.abs());
        let rows = Self([x + xy + xz, y + xy + yz, z + xz + yz, 0.0, 0.0, 0.0]);
        ((self + o).times(0.5) + rows).up()
    }
}

/// Turns a matrix in a plane, so that its entry there is 0, by Jacobi.
fn rotate(rows: &mut [[f64; 3]; 3], i: usize, j: usize) {
    if rows[i][j] == 0.0 {
        return;
    }
    let ratio = (rows[j][j] - rows[i][i]) / (2.0 * rows[i][j]);
    let tangent = 1.0_f64.copysign(ratio) / (ratio.abs() + (ratio * ratio + 1.0).sqrt());
    let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
    let sine = tangent * cosine;
    for row in rows.iter_mut() {
        (row[i], row[j]) = (
            cosine * row[i] - sine * row[j],
            sine * row[i] + cosine * row[j],
        );
    }
    let (a, b) = (rows[i], rows[j]);
    rows[i] = [0, 1, 2].map(|k| cosine * a[k] - sine * b[k]);
    rows[j] = [0, 1, 2].map(|k| sine * a[k] + cosine * b[k]);
}

impl Add for Form {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        let mut sum = self;
        for (entry, other) in sum.0.iter_mut().zip(o.0) {
            *entry += other;
        }
        sum
    }
}

impl Sub for Form {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Neg for Form {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|entry| -entry))
    }
}

/// The middle of a gradient's ranges, how long it is, and how far the gradient can be from it.
fn middle(steep: &Steep) -> ([f64; 3], f64, f64) {
    let middle = steep.gradient().map(Interval::mid);
    let gradient = steep.gradient().into_iter().zip(middle);
    // From the rounded middle, to either end.
    let off = gradient.map(|(range, middle)| (range - Interval::point(middle)).magnitude());
    (middle, length(middle.map(f64::abs)), length(off))
}

/// A form above the square of the slope in each direction, `(g.u)^2` for the gradient g: the least of those by its length, by
/// its middle, and by its components.
fn squares(steep: &Steep) -> Form {
    let (middle, long, off) = middle(steep);
    let by_length = Form::all(steep.slope() * steep.slope());
    let by_middle = Form::crossed(middle, middle).times(0.5) + Form::all((2.0 * long + off) * off);
    // (sum of |g_i| |u_i|)^2 is at most the sum of |g_i| times the sum of |g_i| u_i^2, by Cauchy and Schwarz.
    let sizes = steep.gradient().map(Interval::magnitude);
    let [x, y, z] = sizes.map(|size| size * sizes.into_iter().sum::<f64>());
    let by_components = Form([x, y, z, 0.0, 0.0, 0.0]);
    [by_middle, by_components]
        .into_iter()
        .fold(by_length, |best, form| {
            if form.trace() < best.trace() {
                form
            } else {
                best
            }
        })
        .up()
}

/// Two quadratic forms, between which the second derivatives lie in each direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Forms {
    low: Form,
    high: Form,
}

impl Forms {
    /// Those of a field without bends.
    pub const ZERO: Self = Self {
        low: Form::ZERO,
        high: Form::ZERO,
    };

    /// Whether the field is known to have no bends.
    pub fn are_zero(&self) -> bool {
        [self.low, self.high].map(Form::largest_entry) == [0.0; 2]
    }

    /// All of a field whose bends are at most so far from 0.
    fn within(most: Form) -> Self {
        Self {
            low: -most,
            high: most,
        }
    }

    /// With room for rounding; none if anything is infinite.
    fn rounded(low: Form, high: Form) -> Option<Self> {
        let is_finite = |form: Form| form.0.into_iter().all(f64::is_finite);
        (is_finite(low) && is_finite(high)).then(|| Self {
            low: -(-low).up(),
            high: high.up(),
        })
    }

    /// How far they are apart, in all directions together.
    fn spread(&self) -> f64 {
        (self.high - self.low).trace()
    }

    /// The closer pair of two.
    pub fn closer(self, o: Self) -> Self {
        if o.spread() < self.spread() { o } else { self }
    }

    /// The bends that they allow in any direction.
    pub fn bend(&self) -> Interval {
        Interval {
            lo: -(-self.low).most(),
            hi: self.high.most(),
        }
    }

    /// Those of a sum.
    pub fn plus(self, o: Self) -> Option<Self> {
        Self::rounded(self.low + o.low, self.high + o.high)
    }

    /// Those of the opposite.
    pub fn opposite(self) -> Self {
        Self {
            low: -self.high,
            high: -self.low,
        }
    }

    /// Those times a number of a range.
    pub fn times(self, by: Interval) -> Option<Self> {
        let Interval { lo, hi } = by;
        if !lo.is_finite() || !hi.is_finite() {
            return None;
        }
        if lo < 0.0 && hi <= 0.0 {
            return self.opposite().times(-by);
        }
        // The products of the ends that are above all others, and those below them.
        let (least, most) = if lo < 0.0 {
            (self.high.times(lo), self.low.times(lo))
        } else {
            (self.low.times(lo), self.high.times(lo))
        };
        let low = -(-least).join(-self.low.times(hi));
        Self::rounded(low, most.join(self.high.times(hi)))
    }

    /// Those of the square of the slope in each direction, times a number of a range.
    pub fn of_squares(steep: &Steep, by: Interval) -> Option<Self> {
        if steep.slope() == 0.0 {
            return Some(Self::ZERO);
        }
        let squares = squares(steep);
        Self::rounded(squares.times(by.lo.min(0.0)), squares.times(by.hi.max(0.0)))
    }

    /// Those of twice the product of the slopes of two fields in each direction, which is in a range: by that, by the squares
    /// of the slopes, or by the middles of the gradients.
    pub fn crossed(a: &Steep, b: &Steep, range: Interval) -> Option<Self> {
        if a.slope() == 0.0 || b.slope() == 0.0 {
            return Some(Self::ZERO);
        }
        // 2 x y is at most x^2 t + y^2 / t.
        let [first, second] = [a, b].map(squares);
        let share = (second.trace() / first.trace()).sqrt();
        let by_squares = Self::within(first.times(share) + second.times(1.0 / share));
        let [(first, long, off), (second, other_long, other_off)] = [a, b].map(middle);
        let off = 2.0 * (long * other_off + off * other_long + off * other_off);
        let middles = Form::crossed(first, second);
        let all = [
            Self::rounded(Form::all(range.lo), Form::all(range.hi)),
            Self::rounded(by_squares.low, by_squares.high),
            Self::rounded(middles - Form::all(off), middles + Form::all(off)),
        ];
        all.into_iter().flatten().reduce(Self::closer)
    }
}

/// A sine of a phase without bends, with its largest value.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wave {
    amplitude: f64,
    /// A form above the square of the phase's slope.
    squares: Form,
}

impl Wave {
    /// Of amplitude 1.
    pub fn of(phase: &Steep) -> Self {
        Self {
            amplitude: 1.0,
            squares: squares(phase),
        }
    }

    /// So many times as large.
    pub fn times(self, by: Interval) -> Self {
        Self {
            amplitude: (self.amplitude * by.magnitude()).next_up(),
            ..self
        }
    }

    /// The forms of the product with another. With phases a and b it is half the sum of a wave of `a + b` and one of `a - b`,
    /// which are bent by no more than `((a + b)'^2 + (a - b)'^2) / 2 = a'^2 + b'^2`.
    pub fn product(self, o: Self) -> Option<Forms> {
        let most = (self.squares + o.squares).times(self.amplitude * o.amplitude);
        Forms::rounded(-most, most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::samples::Samples;

    const SEED: u64 = 0xf0f0;

    fn random_form(samples: &mut Samples) -> Form {
        let size = samples.scaled(-2.0, 2.0);
        let is_diagonal = samples.below(4) == 0;
        let mut form = Form([0.0; 6].map(|_: f64| size * samples.uniform(-1.0, 1.0)));
        if is_diagonal {
            form.0[3..].fill(0.0);
        }
        form
    }

    /// The form in a random direction.
    fn along(form: Form, [x, y, z]: [f64; 3]) -> f64 {
        let parts = [x * x, y * y, z * z, 2.0 * x * y, 2.0 * x * z, 2.0 * y * z];
        form.0.iter().zip(parts).map(|(a, b)| a * b).sum()
    }

    fn direction(samples: &mut Samples) -> [f64; 3] {
        let parts = [0.0; 3].map(|_: f64| samples.uniform(-1.0, 1.0));
        let long = parts.into_iter().fold(0.0, f64::hypot);
        parts.map(|part| part / long)
    }

    #[test]
    fn no_direction_shows_more_than_the_most() {
        let mut samples = Samples::new(SEED);
        for _ in 0..2000 {
            let form = random_form(&mut samples);
            let most = form.most();
            let mut seen = f64::NEG_INFINITY;
            // Uphill by the power method on a form that is shifted to be positive.
            let mut u = direction(&mut samples);
            let shift = 6.0 * form.largest_entry();
            for _ in 0..3000 {
                seen = seen.max(along(form, u));
                let [x, y, z, xy, xz, yz] = form.0;
                let rows = [[x, xy, xz], [xy, y, yz], [xz, yz, z]];
                let turned = [0, 1, 2].map(|i| {
                    let product: f64 = rows[i].iter().zip(u).map(|(a, b)| a * b).sum();
                    product + shift * u[i]
                });
                let long = turned.into_iter().fold(0.0, f64::hypot);
                u = turned.map(|part| part / long);
            }
            let size = form.largest_entry();
            assert!(seen <= most, "{form:?}: {seen} above {most}");
            assert!(most - seen <= 1e-2 * size, "{form:?}: {most}, seen {seen}");
        }
    }

    #[test]
    fn joins_and_products_hold_in_every_direction() {
        let mut samples = Samples::new(SEED);
        for round in 0..2000 {
            let (a, mut b) = (random_form(&mut samples), random_form(&mut samples));
            if round % 3 == 0 {
                // Comparable ones are not widened.
                b = a + Form::all(b.largest_entry());
                assert!((a.join(b) - b).largest_entry() <= 1e-12 * b.largest_entry());
            }
            let join = a.join(b);
            let forms = Forms {
                low: -b.join(-a),
                high: join,
            };
            let ends = [samples.scaled(-1.0, 1.0), samples.scaled(-1.0, 1.0)];
            let by = Interval::new(ends[0].min(ends[1]), ends[0].max(ends[1]));
            let product = forms.times(by).expect("finite forms");
            for _ in 0..20 {
                let u = direction(&mut samples);
                let room = 1e-12 * (a.largest_entry() + b.largest_entry());
                assert!(along(join, u) >= along(a, u).max(along(b, u)) - room);
                for end in [forms.low, forms.high] {
                    for share in [by.lo, by.hi] {
                        let bend = share * along(end, u);
                        assert!(bend <= along(product.high, u) + room, "{forms:?} {by:?}");
                        assert!(bend >= along(product.low, u) - room, "{forms:?} {by:?}");
                    }
                }
            }
        }
    }
}
