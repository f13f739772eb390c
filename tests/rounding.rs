//! Rounding errors of whole fields: what `f32` computes lies within the bound, for every entry of the catalogue, for
//! fields of scripts and for scenes.
//!
//! `f32` alone gives the bits of its lanes (`tests/catalogue`).

#[path = "catalogue/entries.rs"]
mod entries;
#[allow(dead_code)]
#[path = "catalogue/samples.rs"]
mod samples;
mod stub;

use entries::{REACH, entries_and_fields, object, part, region};
use fieldstone::catalogue::*;
use fieldstone::field::{Closure, compile};
use fieldstone::num::{Interval, Rounded, Vec3};
use fieldstone::scene::Node;
use samples::Dice;
use std::time::Instant;

/// The unit roundoff of `f32`.
const UNIT: f64 = 1.0 / (1 << 24) as f64;

/// By how many units, of the largest coordinate, coordinates are off.
const COORDINATE_UNITS: f64 = 16.0;

/// A field over all the numbers that are compared.
struct Field {
    bound: Closure<Rounded>,
    single: Closure<f32>,
    double: Closure<f64>,
}

/// A bound over a region, and the largest difference seen there.
#[derive(Clone, Copy, Debug)]
struct Measured {
    bound: f64,
    seen: f64,
}

impl Measured {
    fn ratio(self) -> f64 {
        self.bound / self.seen
    }
}

impl Field {
    fn new(node: &Node) -> Self {
        Self {
            bound: compile(node),
            single: compile(node),
            double: compile(node),
        }
    }

    fn bound(&self, region: &Bounds, error: f64) -> Rounded {
        let [x, y, z] = std::array::from_fn(|i| {
            Rounded::new(Interval::new(region.low[i], region.high[i]), error)
        });
        (self.bound)(&Vec3::new(x, y, z))
    }

    /// The differences at `n` points of the region, each coordinate moved by up to its error.
    fn measure(&self, region: &Bounds, n: usize, dice: &mut Dice) -> Result<Measured, String> {
        let largest = (0..3).map(|i| region.reach(i)).fold(0.0, f64::max);
        let error = COORDINATE_UNITS * UNIT * largest;
        let bound = self.bound(region, error);
        let mut seen: f64 = 0.0;
        for _ in 0..n {
            let p = dice.point(region);
            let moved = p.map(|c| near(c, error, dice));
            let exact = (self.double)(&Vec3::splat(p));
            let [x, y, z] = moved;
            let computed = (self.single)(&Vec3::new(x, y, z));
            let off = (f64::from(computed) - exact).abs();
            let is_held =
                off <= bound.error() + 1e-12 * exact.abs() && bound.range().contains(exact);
            if exact.is_finite() && bound.error() < f64::INFINITY && !is_held {
                return Err(format!(
                    "{computed:e} at {moved:?} for {exact:e} at {p:?}, {bound:?}"
                ));
            }
            if off.is_finite() {
                seen = seen.max(off);
            }
        }
        Ok(Measured {
            bound: bound.error(),
            seen,
        })
    }
}

/// A number in `f32` that is off by at most `error`, half of the time by as much as may be.
fn near(c: f64, error: f64, dice: &mut Dice) -> f32 {
    let share = match dice.below(4) {
        0 => 1.0,
        1 => -1.0,
        _ => dice.between(-1.0, 1.0),
    };
    let moved = (c + share * error) as f32;
    let is_near = (f64::from(moved) - c).abs() <= error;
    if is_near { moved } else { c as f32 }
}

fn middle(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

#[test]
fn entries_of_the_catalogue_are_off_by_no_more() {
    let fields = entries_and_fields();
    let (mut unbounded, mut loose, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    for (i, (name, node)) in fields.iter().enumerate() {
        let (field, dice) = (Field::new(node), &mut Dice::new(i as u64));
        let region = region(node);
        let measured = |region: &Bounds, n: usize, dice: &mut Dice| {
            let measured = field.measure(region, n, dice);
            measured.unwrap_or_else(|why| panic!("{name} (number {i}): {why}"))
        };
        let whole = measured(&region, 1_000, dice);
        let parts = (0..20).map(|_| {
            let part = part(&region, dice);
            measured(&part, 50, dice).ratio()
        });
        let parts = middle(parts.collect());
        println!(
            "{name:30} bound {:8.1e} seen {:8.1e} ratio {:8.1}, in parts {parts:8.1}",
            whole.bound,
            whole.seen,
            whole.ratio()
        );
        ratios.push(parts);
        if whole.bound == f64::INFINITY {
            unbounded.push(name.clone());
        } else if whole.bound > 1e-2 {
            loose.push(name.clone());
        }
    }
    let n = fields.len();
    println!("without a bound: {unbounded:?}\nlarge bound: {loose:?}");
    let typical = middle(ratios);
    println!("{n} fields, median ratio in parts {typical}");
    assert!(
        5 * unbounded.len() < n,
        "{} of {n}: {unbounded:?}",
        unbounded.len()
    );
    assert!(2 * loose.len() < n, "{} of {n}: {loose:?}", loose.len());
    assert!(typical < 20.0, "{typical}");
}

/// Scenes of the benchmarks, each with how many times the largest difference seen the bound may be.
#[test]
fn scenes_have_useful_bounds() {
    for (name, most) in [("s2", 50.0), ("s3", 50.0), ("s6", 50.0)] {
        let field = Field::new(&object(name));
        let region = Bounds::centred([REACH; 3]);
        let measured = field.measure(&region, 40_000, &mut Dice::new(2));
        let measured = measured.unwrap_or_else(|why| panic!("{name}: {why}"));
        let start = Instant::now();
        let alone = field.bound(&region, 0.0).error();
        let time = start.elapsed();
        println!(
            "{name}: bound {:.2e}, seen {:.2e}, ratio {:.1}; {alone:.2e} of exact coordinates; {time:?}",
            measured.bound,
            measured.seen,
            measured.ratio()
        );
        assert!(measured.ratio() < most, "{name}: {measured:?}");
    }
}
