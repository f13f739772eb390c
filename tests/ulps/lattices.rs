//! Noise and the distance to scattered points, against their definitions in whole numbers and twice the bits of `f64`.

use super::precision::{Precision, Worst};
use super::samples::Samples;
use fieldstone::num::Lattice;
use std::cmp::Ordering;
use std::ops::{Add, Mul, Sub};

/// A number as a sum of two, off by some 2^-104 of itself. Source: Dekker 1971; Hida, Li, Bailey 2001.
#[derive(Clone, Copy, Debug)]
struct Double {
    high: f64,
    low: f64,
}

impl Double {
    const fn new(high: f64) -> Self {
        Self { high, low: 0.0 }
    }

    /// The exact sum.
    fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let of_b = high - a;
        let low = (a - (high - of_b)) + (b - of_b);
        Self { high, low }
    }

    /// The exact product, of halves of 26 bits.
    fn product(a: f64, b: f64) -> Self {
        let halves = |x: f64| {
            let moved = x * 134_217_729.0;
            let upper = moved - (moved - x);
            (upper, x - upper)
        };
        let ((a1, a2), (b1, b2)) = (halves(a), halves(b));
        let high = a * b;
        let low = ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2;
        Self { high, low }
    }

    fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::new(0.0);
        }
        let root = self.high.sqrt();
        let rest = self - Self::product(root, root);
        Self::sum(root, rest.high / (2.0 * root))
    }
}

impl Add for Double {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        let (upper, lower) = (Self::sum(self.high, o.high), Self::sum(self.low, o.low));
        let upper = Self::sum(upper.high, upper.low + lower.high);
        Self::sum(upper.high, upper.low + lower.low)
    }
}

impl Sub for Double {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + Self {
            high: -o.high,
            low: -o.low,
        }
    }
}

impl Mul for Double {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let product = Self::product(self.high, o.high);
        let low = product.low + (self.high * o.low + self.low * o.high);
        Self::sum(product.high, low)
    }
}

/// The hash of a cell, in whole numbers.
fn hash(cell: [i64; 3]) -> i64 {
    cell.iter().fold(0, |h, i| {
        let x = h + i.rem_euclid(289);
        (34 * x + 10) * x % 289
    })
}

/// Which of the lattice's points is meant, and the way from there, exactly.
fn way(p: [f64; 3], corner: [i64; 3]) -> [Double; 3] {
    std::array::from_fn(|k| Double::sum(p[k], -(corner[k] as f64)))
}

/// The cell of a point and those around it, from `low` to `high` along each axis.
fn around(p: [f64; 3], low: i64, high: i64) -> impl Iterator<Item = [i64; 3]> {
    let first = p.map(|c| c.floor() as i64);
    (low..=high).flat_map(move |i| {
        (low..=high).flat_map(move |j| {
            (low..=high).map(move |k| [first[0] + i, first[1] + j, first[2] + k])
        })
    })
}

/// The sum over the corners of the cell of their weights times the product of their gradients and the ways from them.
fn noise(p: [f64; 3]) -> Double {
    let floor = p.map(f64::floor);
    let fade = |t: Double| {
        let [six, fifteen, ten] = [6.0, 15.0, 10.0].map(Double::new);
        t * t * t * (t * (t * six - fifteen) + ten)
    };
    let mut sum = Double::new(0.0);
    for corner in around(p, 0, 1) {
        let from = way(p, corner);
        let mut weight = Double::new(1.0);
        for k in 0..3 {
            let share = fade(Double::sum(p[k], -floor[k]));
            let is_far = corner[k] as f64 > floor[k];
            weight = weight
                * if is_far {
                    share
                } else {
                    Double::new(1.0) - share
                };
        }
        let number = hash(corner) % 12;
        let (axis, sign) = (number as usize / 4, |bit: i64| {
            Double::new(1.0 - 2.0 * (bit & 1) as f64)
        });
        let height = sign(number) * from[axis] + sign(number >> 1) * from[(axis + 1) % 3];
        sum = sum + weight * height;
    }
    sum
}

/// The distance to the nearest of the points in this cell and all within two of it.
fn voronoi(p: [f64; 3]) -> Double {
    let squares = around(p, -2, 2).map(|cell| {
        let h = hash(cell);
        let place = [h % 7 * 2 + 2, h / 7 % 7 * 2 + 2, h / 49 * 2 + 3].map(|n| n as f64 / 16.0);
        let [x, y, z] = way(p, cell);
        let [x, y, z] = [
            x - Double::new(place[0]),
            y - Double::new(place[1]),
            z - Double::new(place[2]),
        ];
        x * x + y * y + z * z
    });
    let order = |a: &Double, b: &Double| (a.high, a.low).partial_cmp(&(b.high, b.low));
    let nearest = squares.min_by(|a, b| order(a, b).unwrap_or(Ordering::Equal));
    nearest.expect("125 of them").sqrt()
}

/// A coordinate in reach: of every size, in one period, beside whole numbers and halves, beside multiples of the period.
fn coordinate<T: Precision>(samples: &mut Samples, reach: f64) -> T {
    let size = libm::exp2(samples.uniform(-40.0, reach));
    let x = match samples.below(8) {
        0 => samples.uniform(-size, size),
        1 => samples.uniform(-size, size).trunc(),
        2 => (2.0 * samples.uniform(-size, size)).trunc() / 2.0,
        3 => (samples.uniform(-size, size) / 289.0).trunc() * 289.0,
        4 => libm::exp2(samples.uniform(-1074.0, 0.0)),
        _ => samples.uniform(-289.0, 289.0),
    };
    let x = T::nearest(if samples.bits() & 1 == 0 { x } else { -x });
    match samples.below(8) {
        0 => beside(x, 1),
        1 => beside(x, -1),
        2 => x + T::splat(samples.uniform(-1e-3, 1e-3)),
        _ => x,
    }
}

/// The number next to `x`, further from zero or nearer to it.
fn beside<T: Precision>(x: T, step: i64) -> T {
    let is_zero = x.wide() == 0.0 && step < 0;
    if is_zero {
        x
    } else {
        T::from_pattern(x.pattern().wrapping_add_signed(step))
    }
}

/// The worst error in units of half an `EPSILON`, each as a share of what `Lattice::roundings` allows.
fn check<T: Precision>(lattice: Lattice, exact: fn([f64; 3]) -> Double, reach: f64, count: u32) {
    let unit = libm::exp2(-f64::from(T::FRACTION_BITS + 1));
    let mut samples = Samples::new(0x1a771ce);
    let mut worst = Worst::NONE;
    for _ in 0..count {
        let p: [T; 3] = [(); 3].map(|()| coordinate(&mut samples, reach));
        let got = T::lattice(lattice, p[0], p[1], p[2]).wide();
        let off = Double::new(got) - exact(p.map(T::wide));
        worst.see(off.high.abs() / unit, || {
            format!("{:e} {:e} {:e}", p[0], p[1], p[2])
        });
    }
    worst.must_be_within(
        lattice.roundings(),
        &format!("{lattice:?} in {}, in half epsilons", T::NAME),
    );
}

#[test]
fn noise_is_off_by_no_more_than_its_roundings() {
    check::<f32>(Lattice::Noise, noise, 22.0, 300_000);
    check::<f64>(Lattice::Noise, noise, 51.0, 300_000);
}

#[test]
fn distances_to_scattered_points_are_off_by_no_more_than_their_roundings() {
    check::<f32>(Lattice::Voronoi, voronoi, 22.0, 60_000);
    check::<f64>(Lattice::Voronoi, voronoi, 51.0, 60_000);
}

/// Products and roots whose exact values are known.
#[test]
fn doubles_have_twice_the_bits() {
    let tiny = libm::exp2(-80.0);
    let x = Double {
        high: 1.0,
        low: tiny,
    };
    let square = x * x;
    assert_eq!([square.high, square.low], [1.0, 2.0 * tiny]);
    let root = square.sqrt();
    assert_eq!([root.high, root.low], [1.0, tiny]);
    let zero = x - Double::new(1.0) - Double::new(tiny);
    assert_eq!([zero.high, zero.low], [0.0, 0.0]);
    let third = Double::product(1.0 / 3.0, 3.0) - Double::new(1.0);
    assert_eq!(third.high + third.low, -libm::exp2(-54.0));
}
