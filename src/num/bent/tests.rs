//! Bends against second differences: random expressions over random regions, and closed forms.

use super::*;
use crate::num::samples::{Samples, Tree, binary, unary};
use crate::num::{Lattice, Rounded};

const SEED: u64 = 0xbe27;
const REGIONS: usize = 4_000;

/// By how much less f64 rounds than f32, and a factor of 4 for what is not linear in the roundings.
const OF_SINGLE: f64 = 4.0 / (1_u64 << 29) as f64;

/// An interval of moderate size, about the origin, next to it or away from it.
fn interval(samples: &mut Samples) -> Interval {
    let radius = samples.scaled(-2.5, 0.7).abs();
    let center = match samples.below(4) {
        0 => 0.0,
        1 => radius,
        _ => samples.uniform(-3.0, 3.0),
    };
    Interval::new(center - radius, center + radius)
}

fn variables(region: [Interval; 3]) -> [Bent; 3] {
    [0, 1, 2].map(|i| Bent::variable(region[i], i))
}

/// A place and the way from it to either end of a straight piece in the region, of any size.
fn piece(region: [Interval; 3], samples: &mut Samples) -> ([f64; 3], [f64; 3]) {
    let (a, b) = ([0; 3], [0; 3]);
    let mut ends = [a, b].map(|end| {
        let mut i = 0;
        end.map(|_: i32| {
            i += 1;
            samples.uniform(region[i - 1].lo, region[i - 1].hi)
        })
    });
    if samples.below(3) == 0 {
        // Along an axis.
        let axis = samples.below(3);
        let kept = ends[1][axis];
        ends[1] = ends[0];
        ends[1][axis] = kept;
    }
    let size = libm::exp10(samples.uniform(-3.0, 0.0));
    let [a, b] = ends;
    let middle = [0, 1, 2].map(|i| a[i] + 0.5 * size * (b[i] - a[i]));
    (middle, [0, 1, 2].map(|i| 0.49 * size * (b[i] - a[i])))
}

/// What was seen of bounds.
#[derive(Default, Debug)]
struct Seen {
    low: usize,
    high: usize,
    telling: usize,
}

/// A coordinate in `f32`, with a neighbourhood: at one point alone roundings may be small by chance.
fn single(c: f64) -> Rounded {
    let error = c.abs() / f64::from(1 << 24);
    Rounded::new(Interval::new(c - 16.0 * error, c + 16.0 * error), error)
}

/// The second difference of `f` at `p` to `way` on both sides, by the square of its length, with its possible error;
/// none where there is no value.
fn bend_at(
    f: impl Fn([f64; 3]) -> f64,
    error: impl Fn([Rounded; 3]) -> f64,
    (p, way): ([f64; 3], [f64; 3]),
) -> Option<(f64, f64)> {
    let at = |share: f64| [0, 1, 2].map(|i| p[i] + share * way[i]);
    let points = [-1.0, 0.0, 1.0].map(at);
    let noise = points.map(|at| error(at.map(single)));
    let [a, m, b] = points.map(f);
    let squared = way.into_iter().map(|c| c * c).sum::<f64>();
    let [e, d, g] = noise;
    let noise = OF_SINGLE * (e + 2.0 * d + g) + f64::EPSILON * (a.abs() + m.abs() + b.abs());
    let (second, noise) = ((a - m + (b - m)) / squared, noise / squared);
    (second.is_finite() && noise.is_finite()).then_some((second, noise))
}

/// What is wrong with bounds, if anything.
fn verify(bent: Bent, (second, noise): (f64, f64), seen: &mut Seen) -> Option<String> {
    assert!(bent.low() <= bent.high(), "{bent:?}");
    seen.low += usize::from(bent.low().is_finite());
    seen.high += usize::from(bent.high().is_finite());
    let width = bent.high() - bent.low();
    seen.telling += usize::from(noise < 0.1 * width && width < 100.0 * (second.abs() + 1e-9));
    let noise = noise + 1e-9 * second.abs();
    let is_held = bent.low() - noise <= second && second <= bent.high() + noise;
    (!is_held).then(|| format!("{second:e} +- {noise:e} in {bent:?}"))
}

#[test]
fn functions_of_one_number_bend_no_more() {
    let mut samples = Samples::new(SEED);
    let functions = unary::<Bent>().into_iter().zip(unary::<f64>());
    for (((name, bent), (_, f)), (_, rounded)) in functions.zip(unary::<Rounded>()) {
        let mut seen = Seen::default();
        for _ in 0..REGIONS {
            let region = [(); 3].map(|()| interval(&mut samples));
            // Straight, bent one way, and either.
            let inner = samples.below(3);
            let [x, y, _] = variables(region);
            let bound = match inner {
                0 => bent(x),
                1 => bent(x.square()),
                _ => bent(x * y),
            };
            for _ in 0..4 {
                let found = bend_at(
                    |[x, y, _]| match inner {
                        0 => f(x),
                        1 => f(x * x),
                        _ => f(x * y),
                    },
                    |[x, y, _]| match inner {
                        0 => rounded(x).error(),
                        1 => rounded(x * x).error(),
                        _ => rounded(x * y).error(),
                    },
                    piece(region, &mut samples),
                );
                let wrong = found.and_then(|found| verify(bound, found, &mut seen));
                assert!(
                    wrong.is_none(),
                    "{name} of inner {inner} over {region:?}: {wrong:?}, seed {SEED:#x}"
                );
            }
        }
        println!("{name}: {seen:?}");
        assert!(seen.low + seen.high > REGIONS, "{name}: {seen:?}");
    }
}

#[test]
fn functions_of_two_numbers_bend_no_more() {
    let mut samples = Samples::new(SEED);
    let functions = binary::<Bent>().into_iter().zip(binary::<f64>());
    for (((name, bent), (_, f)), (_, rounded)) in functions.zip(binary::<Rounded>()) {
        let mut seen = Seen::default();
        for _ in 0..REGIONS {
            let region = [(); 3].map(|()| interval(&mut samples));
            let [x, y, z] = variables(region);
            let is_bent = samples.below(2) == 0;
            let bound = if is_bent {
                bent(x * z, y.square() - z)
            } else {
                bent(x, y)
            };
            for _ in 0..4 {
                let found = bend_at(
                    |[x, y, z]| {
                        if is_bent {
                            f(x * z, y * y - z)
                        } else {
                            f(x, y)
                        }
                    },
                    |[x, y, z]| {
                        if is_bent {
                            rounded(x * z, y * y - z).error()
                        } else {
                            rounded(x, y).error()
                        }
                    },
                    piece(region, &mut samples),
                );
                let wrong = found.and_then(|found| verify(bound, found, &mut seen));
                assert!(
                    wrong.is_none(),
                    "{name} (bent: {is_bent}) over {region:?}: {wrong:?}, seed {SEED:#x}"
                );
            }
        }
        println!("{name}: {seen:?}");
        assert!(
            name == "voronoi" || seen.low + seen.high > REGIONS / 4,
            "{name}: {seen:?}"
        );
    }
}

#[test]
fn random_expressions_bend_no_more() {
    let mut samples = Samples::new(SEED);
    let mut seen = Seen::default();
    for round in 0..5 * REGIONS {
        let tree = Tree::random(&mut samples, 1 + round % 4);
        let region = [(); 3].map(|()| interval(&mut samples));
        let bound = tree.value(variables(region));
        for _ in 0..4 {
            let found = bend_at(
                |p| {
                    let is_defined = tree.all_steps(p, |x: f64| x.is_finite());
                    if is_defined { tree.value(p) } else { f64::NAN }
                },
                |p| tree.value(p).error(),
                piece(region, &mut samples),
            );
            let wrong = found.and_then(|found| verify(bound, found, &mut seen));
            assert!(
                wrong.is_none(),
                "{tree:?} over {region:?}: {wrong:?}, seed {SEED:#x}"
            );
        }
    }
    println!("{seen:?}");
    assert!(
        seen.low > 4 * REGIONS && seen.high > 4 * REGIONS,
        "{seen:?}"
    );
    assert!(seen.telling > REGIONS, "{seen:?}");
}

/// Asserts that the bends are these or a little wider.
fn assert_bends(found: Bent, [low, high]: [f64; 2]) {
    let is_near = |outer: f64, inner: f64| {
        outer == inner || outer >= inner && outer - inner <= 1e-9 * (1.0 + inner.abs())
    };
    assert!(
        is_near(-found.low(), -low) && is_near(found.high(), high),
        "{found:?}, expected {low} to {high}"
    );
}

#[test]
fn bends_of_simple_fields_are_those_of_their_closed_forms() {
    let over = |ends: [[f64; 2]; 3]| variables(ends.map(|[lo, hi]| Interval::new(lo, hi)));
    let infinity = f64::INFINITY;
    let [x, y, z] = over([[-1.0, 2.0], [-1.0, 1.0], [-3.0, 1.0]]);
    let two = Bent::splat(2.0);
    assert_bends(x + y - z * two, [0.0, 0.0]);
    assert_bends(x * y, [-1.0, 1.0]);
    assert_bends(x.square() + y.square(), [0.0, 2.0]);
    assert_bends(x.powi(3), [-6.0, 12.0]);
    assert_bends(x.abs(), [0.0, infinity]);
    assert_bends(x.max(-x), [0.0, infinity]);
    assert_bends(x.min(-x), [-infinity, 0.0]);
    assert_bends(x.square().max(y), [0.0, infinity]);
    assert_bends(x.floor(), [-infinity, infinity]);
    assert_bends(Bent::select_lt(x, y, z, x), [-infinity, infinity]);
    assert_bends(Bent::select_lt(x, two + two, z, x), [0.0, 0.0]);
    assert_bends(Bent::norm3(x, y, z), [0.0, infinity]);
    let [x, y, z] = over([[3.0, 4.0], [4.0, 5.0], [-0.0, 12.0]]);
    // At most 1 by the distance.
    assert_bends(Bent::norm3(x, y, z), [0.0, 0.2]);
    assert_bends(x.hypot(y), [0.0, 0.2]);
    assert_bends(Bent::splat(1.0) / x, [0.0, 2.0 / 27.0]);
    assert_bends(x.sqrt(), [-0.25 * 3.0_f64.powf(-1.5), 0.0]);
    assert_bends(x.floor(), [-infinity, infinity]);
    let [x, y, _] = over([[3.25, 3.75], [-9.0, 9.0], [0.0, 1.0]]);
    assert_bends(x.floor(), [0.0, 0.0]);
    assert_bends(
        y.atan2(x),
        [-1.0 / 3.25_f64.powi(2), 1.0 / 3.25_f64.powi(2)],
    );
    assert_bends(
        (-x).atan2(-y),
        [-1.0 / 3.25_f64.powi(2), 1.0 / 3.25_f64.powi(2)],
    );
    assert_bends(y.atan2(-x), [-infinity, infinity]);
}

#[test]
fn distance_to_a_box_is_convex() {
    let region = [Interval::new(-2.0, 2.5); 3];
    let q = variables(region).map(|c| c.abs() - Bent::splat(1.0));
    let zero = Bent::splat(0.0);
    let [u, v, w] = q.map(|c| c.max(zero));
    let [a, b, c] = q;
    let field = Bent::norm3(u, v, w) + a.max(b).max(c).min(zero);
    // Op by op the inner part may have a kink the other way.
    assert_eq!(field.low(), f64::NEG_INFINITY);
    assert_bends(Bent::norm3(u, v, w), [0.0, f64::INFINITY]);
    let infinity = f64::INFINITY;
    assert_bends(field.with_convexity(variables(region)), [0.0, infinity]);
    // Over a bent space: no more than the point bends.
    let [x, y, z] = variables(region);
    let bent = [x.square(), y, z];
    assert_bends(field.with_convexity(bent), [-2.0, infinity]);
}

#[test]
fn a_wave_in_two_directions_bends_as_its_amplitude_allows() {
    let [x, y, _] = variables([Interval::new(-9.0, 9.0); 3]);
    let four = Bent::splat(4.0);
    let wave = (x * four).sin() * (y * four).cos();
    let most = (-wave.low()).max(wave.high());
    assert!((16.0..=16.0 * (1.0 + 1e-9)).contains(&most), "{wave:?}");
}

/// The gyroid's second derivatives: at most 1 for each product in the plane of its axes, so 2 for each axis.
#[test]
fn sums_of_waves_bend_as_their_directions_allow() {
    let point = variables([Interval::new(-9.0, 9.0); 3]);
    let [x, y, z] = point.map(|q| q * Bent::splat(3.0));
    let gyroid = x.sin() * y.cos() + y.sin() * z.cos() + z.sin() * x.cos();
    assert_bends(gyroid, [-18.0, 18.0]);
    let [a, b, c] = [x, y, z].map(Bent::sin);
    assert_bends(a + b + c, [-9.0, 9.0]);
    assert_bends(a / Bent::splat(-2.0) * b - c, [-9.0, 9.0]);
    // At a kink only the number is left.
    let sheet = gyroid.abs();
    assert!(sheet.forms.is_none());
    assert_bends(sheet, [-18.0, f64::INFINITY]);
}

/// What is held is a constant, and where only an end is touched the slope there is 0.
#[test]
fn smoothsteps_bend_between_their_ends_alone() {
    let [x, y, _] = variables([
        Interval::new(-1.0, 0.3),
        Interval::new(-1.0, 1.0),
        Interval::new(0.0, 1.0),
    ]);
    assert_bends((y.abs() + Bent::splat(2.0)).smoothstep(), [0.0, 0.0]);
    assert_bends((y.floor() - Bent::splat(7.0)).smoothstep(), [0.0, 0.0]);
    assert_bends(x.smoothstep(), [0.0, 6.0]);
    assert!(x.hypot(y).smoothstep().low().is_finite());
}

/// The largest bend of noise times the square of how fast its point moves.
#[test]
fn noise_bends_with_the_square_of_its_frequency() {
    let noise = |[x, y, z]: [Bent; 3]| Bent::lattice(Lattice::Noise, x, y, z);
    let point = variables([Interval::new(-3.0, 5.0); 3]);
    let most = Lattice::Noise.bend();
    assert_bends(noise(point), [-most, most]);
    let finer = point.map(|q| q * Bent::splat(4.0));
    assert_bends(noise(finer), [-16.0 * most, 16.0 * most]);
    // A kink on the way has any bend.
    let [x, y, z] = point;
    assert_bends(noise([x.abs(), y, z]), [f64::NEG_INFINITY, f64::INFINITY]);
}

#[test]
fn scattered_points_have_no_bound() {
    let [x, y, z] = variables([Interval::new(0.0, 1.0); 3]);
    let voronoi = Bent::lattice(Lattice::Voronoi, x, y, z);
    assert_eq!(
        [voronoi.low(), voronoi.high()],
        [f64::NEG_INFINITY, f64::INFINITY]
    );
}
