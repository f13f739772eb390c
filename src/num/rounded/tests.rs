//! Bounds of errors against `f32` itself: random expressions over random regions.

use super::*;
use crate::num::interval::tests::{point_of, random_interval};
use crate::num::lattice::fade;
use crate::num::samples::{Samples, Tree, binary, unary};
use crate::num::{Lattice, Number};

const SEED: u64 = 0x2f32;
const REGIONS: usize = 4_000;
const U: f64 = UNIT;

/// A coordinate over a random interval, with an error that its `f32` values can keep to.
fn coordinate(samples: &mut Samples) -> Rounded {
    let range = random_interval(samples);
    let least = range.magnitude() * U + f64::from(f32::MIN_POSITIVE);
    let error = least * libm::exp10(samples.uniform(0.0, 4.0));
    Rounded::new(range, error)
}

/// An exact value of a coordinate, and a computed one within its error.
fn values(x: Rounded, samples: &mut Samples) -> (f64, f32) {
    let exact = point_of(x.range, samples);
    let share = match samples.below(3) {
        0 => 1.0,
        1 => -1.0,
        _ => samples.uniform(-1.0, 1.0),
    };
    let computed = (exact + share * x.error) as f32;
    let is_near = (f64::from(computed) - exact).abs() <= x.error;
    (exact, if is_near { computed } else { exact as f32 })
}

/// What was seen of one expression over one region.
#[derive(Default)]
struct Seen {
    points: usize,
    largest: f64,
}

/// What is wrong with a bound, if anything: the computed value is further off, or none at all.
fn verify(bound: Rounded, exact: f64, computed: f32, seen: &mut Seen) -> Option<String> {
    if !exact.is_finite() || bound.error() == f64::INFINITY {
        return None;
    }
    let off = (f64::from(computed) - exact).abs();
    seen.points += 1;
    seen.largest = seen.largest.max(off);
    // What f64 takes itself.
    let slack = 1e-12 * exact.abs();
    let is_held = off <= bound.error() + slack && bound.range().contains(exact);
    let is_seen = bound.computed.contains(f64::from(computed));
    (!is_held || !is_seen).then(|| format!("{computed:e} for {exact:e}, {bound:?}"))
}

#[test]
fn functions_of_one_number_are_off_by_no_more() {
    let mut samples = Samples::new(SEED);
    let functions = unary::<Rounded>().into_iter().zip(unary::<f32>());
    for (((name, bound), (_, single)), (_, double)) in functions.zip(unary::<f64>()) {
        let mut seen = Seen::default();
        for _ in 0..REGIONS {
            let x = coordinate(&mut samples);
            let bound = bound(x);
            for _ in 0..8 {
                let (exact, computed) = values(x, &mut samples);
                let wrong = verify(bound, double(exact), single(computed), &mut seen);
                assert!(
                    wrong.is_none(),
                    "{name} of {computed:e} for {exact:e}, {x:?}: {wrong:?}, seed {SEED:#x}"
                );
            }
        }
        assert!(seen.points > REGIONS / 2, "{name}: {} points", seen.points);
    }
}

#[test]
fn functions_of_two_numbers_are_off_by_no_more() {
    let mut samples = Samples::new(SEED);
    let functions = binary::<Rounded>().into_iter().zip(binary::<f32>());
    for (((name, bound), (_, single)), (_, double)) in functions.zip(binary::<f64>()) {
        let mut seen = Seen::default();
        for _ in 0..REGIONS {
            let [x, y] = [0; 2].map(|_| coordinate(&mut samples));
            let bound = bound(x, y);
            for _ in 0..8 {
                let [p, q] = [x, y].map(|x| values(x, &mut samples));
                let (exact, computed) = (double(p.0, q.0), single(p.1, q.1));
                let wrong = verify(bound, exact, computed, &mut seen);
                assert!(
                    wrong.is_none(),
                    "{name} of {p:?}, {q:?}, {x:?}, {y:?}: {wrong:?}, seed {SEED:#x}"
                );
            }
        }
        assert!(seen.points > REGIONS / 2, "{name}: {} points", seen.points);
    }
}

#[test]
fn expressions_are_off_by_no_more() {
    let mut samples = Samples::new(SEED);
    let (mut bounded, mut checked) = (0, 0);
    let regions = 10 * REGIONS;
    for round in 0..regions {
        let tree = Tree::random(&mut samples, 1 + round % 4);
        let at = [0; 3].map(|_| coordinate(&mut samples));
        let bound = tree.value(at);
        bounded += usize::from(bound.error() < f64::INFINITY);
        let mut seen = Seen::default();
        for _ in 0..8 {
            let p = at.map(|x| values(x, &mut samples));
            let exact = p.map(|(exact, _)| exact);
            if !tree.all_steps(exact, f64::is_finite) {
                continue;
            }
            let near = p.map(|(_, computed)| computed);
            let computed: f32 = tree.value(near);
            let wrong = verify(bound, tree.value(exact), computed, &mut seen);
            assert!(
                wrong.is_none(),
                "{tree:?} at {p:?} in {at:?}: {wrong:?}, seed {SEED:#x}"
            );
        }
        checked += seen.points;
    }
    println!("{bounded} of {regions} bounds are finite, {checked} values");
    assert!(2 * bounded > regions, "only {bounded} bounds are finite");
    assert!(checked > 2 * regions, "only {checked} values were checked");
}

/// The bound by the largest error seen, on small regions: half of the expressions are below 4.
#[test]
fn bounds_on_small_regions_are_near_the_errors_seen() {
    let mut samples = Samples::new(SEED);
    let mut ratios = Vec::new();
    for round in 0..REGIONS {
        let tree = Tree::random(&mut samples, 1 + round % 2);
        let at = [0; 3].map(|_| {
            let low = samples.scaled(-1.0, 1.0);
            let range = Interval::new(low, low * (1.0 + 1e-3));
            Rounded::new(range, 16.0 * U * range.magnitude())
        });
        let bound = tree.value(at);
        let mut seen = Seen::default();
        for _ in 0..60 {
            let p = at.map(|x| values(x, &mut samples));
            let exact = p.map(|(exact, _)| exact);
            let near = p.map(|(_, computed)| computed);
            let computed: f32 = tree.value(near);
            let wrong = verify(bound, tree.value(exact), computed, &mut seen);
            assert!(wrong.is_none() || !tree.all_steps(exact, f64::is_finite));
        }
        if seen.largest > 0.0 {
            ratios.push(bound.error() / seen.largest);
        }
    }
    ratios.sort_by(f64::total_cmp);
    let [middle, high] = [2, 10].map(|n| ratios[ratios.len() - ratios.len() / n - 1]);
    println!(
        "{} ratios: median {middle:.2}, nine of ten below {high:.2}",
        ratios.len()
    );
    assert!(ratios.len() > REGIONS / 3, "{} bounds", ratios.len());
    assert!(
        middle < 4.0,
        "half of the bounds are {middle} times as large"
    );
    assert!(high < 100.0, "one of ten bounds is {high} times as large");
}

fn assert_near(found: f64, expected: f64) {
    let is_near = found >= expected && found <= expected * (1.0 + 1e-6);
    assert!(is_near, "{found:e}, expected {expected:e}");
}

#[test]
fn errors_of_arithmetic_are_those_of_the_rules() {
    let [e, f] = [1e-4, 2e-4];
    let a = Rounded::new(Interval::new(-3.0, 1.0), e);
    let b = Rounded::new(Interval::new(4.0, 5.0), f);
    assert_near((a + b).error(), e + f + U * (6.0 + e + f));
    assert_near((a - b).error(), e + f + U * (8.0 + e + f));
    assert_near(
        (a * b).error(),
        3.0 * f + 5.0 * e + e * f + U * (3.0 + e) * (5.0 + f),
    );
    // |a / b| is at most 3 / 4.
    let quotient = (e + 0.75 * f) / (4.0 - f) + U * (3.0 + e) / (4.0 - f);
    assert_near((a / b).error(), quotient);
    assert_near((-a).error(), e);
    assert_near(a.abs().error(), e);
    assert_near(
        a.max(b + Rounded::splat(-4.0)).error(),
        (b + Rounded::splat(-4.0)).error(),
    );
    assert_eq!(a.min(b).error(), a.error());
    assert_eq!((b / a).error(), f64::INFINITY);
    assert_near(Rounded::splat(0.1).error(), f64::from(0.1_f32) - 0.1);
    assert_eq!(Rounded::splat(0.5).error(), 0.0);
}

#[test]
fn errors_of_lengths_and_roots_are_those_of_the_rules() {
    let part = |high: f64, e: f64| Rounded::new(Interval::new(0.0, high), e);
    let [x, y, z] = [(3.0, 3e-4), (4.0, 4e-4), (12.0, 12e-4)].map(|(high, e)| part(high, e));
    // 3 : 4 : 5 and 5 : 12 : 13.
    assert_near(x.hypot(y).error(), 5e-4 + 2.01 * U * 5.0005);
    assert_near(Rounded::norm3(x, y, z).error(), 13e-4 + 2.51 * U * 13.0013);
    // A root moves by the error by the sum of the roots.
    let low = Rounded::new(Interval::new(1e-4, 4.0), 0.75e-4);
    assert_near(low.sqrt().error(), 0.75e-4 / 1.5e-2 + U * 2.000_018_7);
    // From 0 it moves by the root of the error.
    let zero = x.square() + Rounded::new(Interval::new(0.0, 1.0), 0.0);
    assert!(zero.sqrt().error() <= zero.error().sqrt() * 1.000_1 + 4.0 * U);
    let far = Rounded::new(Interval::new(4.0, 9.0), 1e-6);
    assert_near(
        far.sqrt().error(),
        1e-6 / (2.0 + (4.0_f64 - 1e-6).sqrt()) + U * 3.000_000_16,
    );
    // A square is never negative, whatever it is off by.
    assert!(x.square().sqrt().error() < f64::INFINITY);
    assert_eq!((x - x).sqrt().error(), f64::INFINITY);
}

#[test]
fn steps_and_jumps_count_only_where_they_may_be_crossed() {
    let near = |x: f64| Rounded::new(Interval::new(x - 0.1, x + 0.1), 1e-6);
    let (zero, one, five) = (
        Rounded::splat(0.0),
        Rounded::splat(1.0),
        Rounded::splat(5.0),
    );
    assert_eq!(near(2.5).floor().error(), 0.0);
    assert_near(near(2.0).floor().error(), 1.0);
    assert_eq!(Rounded::select_lt(near(-1.0), zero, five, one).error(), 0.0);
    assert_near(Rounded::select_lt(near(0.0), zero, five, one).error(), 4.0);
    // Computed without error, it goes the way of the exact one.
    let exact = Rounded::new(Interval::new(-1.0, 1.0), 0.0);
    assert_eq!(Rounded::select_lt(exact, zero, five, one).error(), 0.0);
    let turn = near(0.0).atan2(near(-1.0)).error();
    assert_near(turn, std::f64::consts::TAU);
    assert!(near(0.5).atan2(near(-1.0)).error() < 1e-5);
}

#[test]
fn what_is_unknown_stays_within_what_holds_it() {
    let (zero, one) = (Rounded::splat(0.0), Rounded::splat(1.0));
    let x = Rounded::new(Interval::new(-1.0, 1.0), 1e-6);
    let unknown = one / x;
    assert_eq!(unknown.error(), f64::INFINITY);
    assert_eq!(
        unknown.sin().error(),
        f64::INFINITY,
        "the sine of infinity is not a number"
    );
    assert_near(unknown.clamp(zero, one).error(), 1.0);
    assert_eq!(Rounded::splat(f64::INFINITY).min(x).error(), x.error());
    assert_eq!(x.max(Rounded::splat(-1e39)).error(), x.error());
    let large = Rounded::splat(1e30);
    assert_eq!((large * large).error(), f64::INFINITY);
    assert_eq!(Rounded::splat(f64::NAN).error(), f64::INFINITY);
    assert_eq!(Rounded::splat(1e39).error(), f64::INFINITY);
}

/// The number in the derivation of the rounding of noise.
#[test]
fn fades_of_noise_add_at_most_117_units() {
    let n = 80;
    let places = |i: usize| i as f64 / n as f64;
    let weight = |t: f64| t.powi(3) * (10.0 + 15.0 * t) + 3.0 * fade(t);
    let mean = |t: f64| t * (1.0 - fade(t)) + (1.0 - t) * fade(t);
    let table: Vec<[f64; 2]> = (0..=n)
        .map(|i| [weight(places(i)), mean(places(i))])
        .collect();
    let mut most: f64 = 0.0;
    for [w, a] in &table {
        for [v, b] in &table {
            for [u, c] in &table {
                let sum = w * (1.0 + 2.0 * (b + c))
                    + v * (1.0 + 2.0 * (a + c))
                    + u * (1.0 + 2.0 * (a + b));
                most = most.max(sum);
            }
        }
    }
    println!("{most}");
    assert!(most > 110.0 && most < 117.0, "{most}");
}

/// Dense points of a few cells: the roundings alone.
#[test]
fn lattice_functions_of_exact_points_keep_their_bound() {
    let mut samples = Samples::new(SEED);
    for lattice in [Lattice::Noise, Lattice::Voronoi] {
        let mut largest: f64 = 0.0;
        for _ in 0..100_000 {
            let p = [0; 3].map(|_| samples.uniform(-3.0, 3.0) as f32);
            let [x, y, z] = p;
            let [u, v, w] = p.map(f64::from);
            let off = f64::from(f32::lattice(lattice, x, y, z)) - f64::lattice(lattice, u, v, w);
            largest = largest.max(off.abs() / U);
        }
        let [x, y, z] = [0; 3].map(|_| Rounded::new(Interval::new(0.3, 0.4), 0.0));
        let bound = Rounded::lattice(lattice, x, y, z).error() / U;
        println!("{lattice:?}: {largest:.2} u seen, at most {bound}");
        assert!(
            largest <= bound && bound < 100.0 * largest,
            "{largest} of {bound}"
        );
    }
}
