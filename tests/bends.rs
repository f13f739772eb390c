//! Second derivatives of whole fields lie within their bounds, for every entry of the catalogue, for fields of scripts and
//! for scenes.

#[path = "catalogue/entries.rs"]
mod entries;
#[allow(dead_code)]
#[path = "catalogue/samples.rs"]
mod samples;
mod stub;

use entries::{REACH, entries_and_fields, object, part, region};
use fieldstone::catalogue::Bounds;
use fieldstone::field::{Closure, compile};
use fieldstone::num::{Bent, Interval, Vec3};
use fieldstone::scene::Node;
use samples::Dice;
use std::f64::consts::SQRT_2;
use std::time::Instant;

/// What `f64` takes of a value, in units of the value and of the coordinates: most fields of the catalogue take less than a
/// tenth of it.
const NOISE: f64 = 1e-13;

/// A field over the numbers that are compared.
struct Field {
    bound: Closure<Bent>,
    value: Closure<f64>,
}

/// The least and the largest second difference that was seen, and what bounds them.
#[derive(Clone, Copy, Debug)]
struct Measured {
    bent: Bent,
    low: f64,
    high: f64,
}

impl Field {
    fn new(node: &Node) -> Self {
        Self {
            bound: compile(node),
            value: compile(node),
        }
    }

    fn bound(&self, region: &Bounds) -> Bent {
        let [x, y, z] = std::array::from_fn(|i| {
            Bent::variable(Interval::new(region.low[i], region.high[i]), i)
        });
        (self.bound)(&Vec3::new(x, y, z))
    }

    /// The second difference along a piece of a line in the region, by the square of half of its length, and what
    /// roundings may change in it.
    fn second_difference(&self, region: &Bounds, dice: &mut Dice) -> [f64; 2] {
        let (start, to) = (dice.point(region), dice.point(region));
        let size = 10.0_f64.powf(dice.between(-3.0, 0.0));
        let way: [f64; 3] = std::array::from_fn(|i| 0.5 * size * (to[i] - start[i]));
        let at = |share: f64| {
            let p = std::array::from_fn(|i| {
                (start[i] + share * way[i]).clamp(region.low[i], region.high[i])
            });
            (self.value)(&Vec3::splat(p))
        };
        let [a, m, b] = [0.0, 1.0, 2.0].map(at);
        let squared: f64 = way.iter().map(|c| c * c).sum();
        let noise = NOISE * (a.abs() + m.abs() + b.abs() + 3.0 * REACH);
        [(a - m + (b - m)) / squared, noise / squared]
    }

    /// The second differences along `n` pieces of lines.
    fn measure(&self, region: &Bounds, n: usize, dice: &mut Dice) -> Result<Measured, String> {
        let bent = self.bound(region);
        let mut measured = Measured {
            bent,
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
        };
        for _ in 0..n {
            let [second, noise] = self.second_difference(region, dice);
            if !second.is_finite() {
                continue;
            }
            let noise = noise + 1e-9 * second.abs();
            if second < bent.low() - noise || second > bent.high() + noise {
                return Err(format!("{second:e} +- {noise:e} in {region:?}, {bent:?}"));
            }
            measured.low = measured.low.min(second + noise);
            measured.high = measured.high.max(second - noise);
        }
        Ok(measured)
    }
}

#[test]
fn entries_of_the_catalogue_bend_no_more() {
    let fields = entries_and_fields();
    let (mut unbounded, mut bounded_in_parts, mut parts) = (Vec::new(), 0, 0);
    for (i, (name, node)) in fields.iter().enumerate() {
        let (field, dice) = (Field::new(node), &mut Dice::new(i as u64));
        let region = region(node);
        let measured = |region: &Bounds, n: usize, dice: &mut Dice| {
            let measured = field.measure(region, n, dice);
            measured.unwrap_or_else(|why| panic!("{name} (number {i}): {why}"))
        };
        let whole = measured(&region, 1_000, dice);
        let in_parts = (0..40).map(|_| {
            let part = part(&region, dice);
            measured(&part, 50, dice).bent.low()
        });
        let lows: Vec<f64> = in_parts.filter(|low| low.is_finite()).collect();
        let least = lows.iter().copied().fold(0.0, f64::min);
        println!(
            "{name:30} low {:9.1e} seen {:9.1e}, high {:9.1e} seen {:9.1e}; {:2} of 40 parts, low {least:9.1e}",
            whole.bent.low(),
            whole.low,
            whole.bent.high(),
            whole.high,
            lows.len()
        );
        (bounded_in_parts, parts) = (bounded_in_parts + lows.len(), parts + 40);
        if !whole.bent.low().is_finite() {
            unbounded.push(name.clone());
        }
    }
    println!("without a bound: {unbounded:?}");
    println!(
        "{} of {} fields, {bounded_in_parts} of {parts} parts",
        fields.len() - unbounded.len(),
        fields.len()
    );
    assert!(
        2 * bounded_in_parts > parts,
        "{bounded_in_parts} of {parts}"
    );
}

/// Scenes of the benchmarks, each with the least second derivative that the rules give.
///
/// S2 has rings, which have a kink on their axes. S3 has three products of waves of frequency 4, each bent by at most
/// 48, divided by 4 (the absolute value and the maximum with a ball keep it). S6 turns by 2 radians a unit at most
/// 0.7 sqrt 2 from the axis, each of two coordinates by two products that bend by 4 times that and 2.
#[test]
fn scenes_have_useful_bounds() {
    for (name, least) in [
        ("s2", f64::NEG_INFINITY),
        ("s3", -36.01),
        ("s6", -2.0 * SQRT_2 * (4.0 * 0.7 * SQRT_2 + 2.0) - 0.01),
    ] {
        let node = object(name);
        let field = Field::new(&node);
        let region = node.bounds().intersect(Bounds::centred([REACH; 3]));
        let start = Instant::now();
        let bent = field.bound(&region);
        let time = start.elapsed();
        let measured = field.measure(&region, 20_000, &mut Dice::new(2));
        let measured = measured.unwrap_or_else(|why| panic!("{name}: {why}"));
        println!(
            "{name}: {:.3} to {:.3}, seen {:.3} to {:.3}; {time:?}",
            bent.low(),
            bent.high(),
            measured.low,
            measured.high
        );
        assert!(bent.low() >= least, "{name}: {measured:?}");
    }
}
