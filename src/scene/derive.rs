//! Lipschitz constants of users' fields, by interval automatic differentiation over a region, refined by subdivision.

use super::{Graph, Mark, Obstacle, Parts};
use crate::catalogue::Bounds;
use crate::num::{Dual, Interval, Steep, Vec3};
use std::collections::BinaryHeap;

/// How many boxes the derivation of one constant may look at.
const MAX_BOXES: usize = 32_768;

/// How many operations of the graph the derivation of one constant may take; a graph with up to 64 of them gets all its
/// boxes. About 40 ns each, so a constant takes at most a tenth of a second.
const MAX_WORK: u64 = 64 * MAX_BOXES as u64;

/// By how much a region is enlarged before its constant is derived, as a share of its radius: so the constant also holds
/// where a shape was only moved, and its region comes back with other roundings.
const SLACK: f64 = 1e-9;

/// The derivation ends when the constant is known this closely: within 3 %.
const ENOUGH: f64 = 1.03;

/// A claim about a slope that a point refutes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refutation {
    /// Where the field is steeper than claimed.
    pub point: [f64; 3],
    /// How steep it is there.
    pub slope: f64,
}

/// A bound of the gradient's length over `region`: infinite where it has none, or where the field jumps.
pub fn gradient_bound(graph: &Graph, region: Bounds) -> f64 {
    let [x, y, z] = std::array::from_fn(|i| {
        let (low, high) = (region.low[i].max(-f64::MAX), region.high[i].min(f64::MAX));
        Steep::variable(Interval::new(low, high), i)
    });
    graph.value(&Vec3::new(x, y, z)).slope()
}

/// The range of the graph's first output over `region`, infinite where no end is known.
pub fn range_of_graph(graph: &Graph, region: Bounds) -> Interval {
    let [x, y, z] = std::array::from_fn(|i| Interval::new(region.low[i], region.high[i]));
    graph.value(&Vec3::new(x, y, z))
}

/// The length of the gradient at a point.
fn steepness(graph: &Graph, point: [f64; 3]) -> Refutation {
    let [x, y, z] = std::array::from_fn(|i| Dual::variable(point[i], i));
    let field: Dual<f64, 3> = graph.value(&Vec3::new(x, y, z));
    let slope = field.partial.iter().fold(0.0, |n: f64, d| n.hypot(*d));
    Refutation { point, slope }
}

/// A Lipschitz constant of the graph's first output on `region`: the largest gradient, at most 3 % above it where
/// a budget of 32 768 boxes allows; infinite where none is known.
pub(super) fn lipschitz_of_graph(graph: &Graph, region: Bounds) -> f64 {
    if region.is_empty() {
        return 0.0;
    }
    let region = one_period(region, graph.periods());
    if !region.is_finite() {
        return gradient_bound(graph, region);
    }
    let slack = SLACK * region.radius();
    graph.remembered(region, slack, |region| {
        let found = derive(graph, region, of_terms(graph, region));
        (found.bound, found.boxes)
    })
}

/// The sum of the constants of a graph's terms, which may be known better than that of the whole: a periodic term is
/// looked at over one period. Infinite where the graph is no sum.
fn of_terms(graph: &Graph, region: Bounds) -> f64 {
    let Parts::Sum(terms) = graph.parts() else {
        return f64::INFINITY;
    };
    let constants = terms.iter().map(|term| lipschitz_of_graph(term, region));
    constants.fold(0.0, |sum, constant| (sum + constant).next_up())
}

/// What the search for a constant finds.
struct Derivation {
    /// The constant.
    bound: f64,
    /// The steepest point that was met.
    steepest: Refutation,
    /// How many boxes were looked at.
    boxes: usize,
}

/// The constant on a finite region where `most_steep` is one already.
fn derive(graph: &Graph, region: Bounds, most_steep: f64) -> Derivation {
    let first = Cell {
        bound: gradient_bound(graph, region).min(most_steep),
        region,
    };
    let most = (MAX_WORK / graph.work().max(1)).clamp(1, MAX_BOXES as u64) as usize;
    let mut steepest = steepness(graph, region.centre());
    let mut cells = BinaryHeap::from([first]);
    // The cell with the largest bound is cut in half until what it says is nearly attained.
    while cells.len() < most {
        let top = cells.peek().expect("the region's cells cover it").bound;
        if top <= steepest.slope * ENOUGH {
            break;
        }
        let cell = cells.pop().expect("peeked just now");
        let halves = halves(&cell.region, 0.5);
        if halves.iter().any(|half| half.size() == cell.region.size()) {
            cells.push(cell);
            break;
        }
        for half in halves {
            let found = steepness(graph, half.centre());
            if found.slope.is_finite() && (found.slope > steepest.slope || steepest.slope.is_nan())
            {
                steepest = found;
            }
            cells.push(Cell {
                bound: gradient_bound(graph, half).min(cell.bound),
                region: half,
            });
        }
    }
    let bound = cells.peek().map_or(f64::INFINITY, |cell| cell.bound);
    Derivation {
        bound,
        steepest,
        boxes: cells.len(),
    }
}

/// What keeps a graph from having a finite constant, and a place where it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trouble {
    /// What it is.
    pub obstacle: Obstacle,
    /// Where in the script it was written.
    pub mark: Mark,
    /// A point next to it.
    pub point: [f64; 3],
}

/// Looks for what keeps `graph` from having a finite constant on `region`: the smallest box that can be found in which
/// some slope still has no bound. Infinite sides are searched up to 10 units from the origin; none where subdivision
/// shows that every slope has a bound.
pub fn trouble(graph: &Graph, region: Bounds) -> Option<Trouble> {
    const SMALLEST: f64 = 1e-9;
    const MOST: u64 = 4096;
    let region = searched(region);
    if region.is_empty() {
        return None;
    }
    let most = (MAX_WORK / graph.work().max(1)).clamp(1, MOST);
    let mut left = vec![region];
    for _ in 0..most {
        let cell = left.pop()?;
        let Some((obstacle, mark)) = graph.obstacle(cell) else {
            continue;
        };
        if cell.radius_about_centre() <= SMALLEST * (1.0 + region.radius()) {
            let point = cell.centre();
            return Some(Trouble {
                obstacle,
                mark,
                point,
            });
        }
        // The half that holds the cell's middle comes first; uneven halves meet no jump at a round number twice.
        left.extend(halves(&cell, 0.4999));
    }
    let cell = left.pop()?;
    let (obstacle, mark) = graph.obstacle(cell)?;
    let point = cell.centre();
    Some(Trouble {
        obstacle,
        mark,
        point,
    })
}

/// The part of a region that is sampled: infinite sides up to 10 units from the origin.
pub(super) fn searched(region: Bounds) -> Bounds {
    if region.is_finite() {
        return region;
    }
    region.intersect(Bounds::centred([10.0; 3]))
}

/// The part of a region that shows every slope of a graph with these periods: one period along each axis, and a little
/// more for rounding.
fn one_period(region: Bounds, periods: [Option<f64>; 3]) -> Bounds {
    let mut part = region;
    for (axis, period) in periods.iter().enumerate() {
        let Some(period) = period else { continue };
        let length = period * (1.0 + 1e-9);
        if region.high[axis] - region.low[axis] > length {
            // The period around the origin, where coordinates are exact; so all large regions are one.
            let low = -0.5 * length;
            (part.low[axis], part.high[axis]) = (low, low + length);
        }
    }
    part
}

/// What becomes of a claimed constant that is put to the test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Claim {
    /// A point shows that it is too small.
    Refuted(Refutation),
    /// The value jumps here.
    Jumps([f64; 3]),
    /// No point was found that refutes it; ranges show that this constant holds (infinite where they show none).
    Derived(f64),
    /// The same, but of an infinite region only the part up to 10 units from the origin was put to the test; this constant
    /// holds on all of it (infinite where none is known).
    Nearby(f64),
}

/// Puts a claim about the slope of a graph on `region` to the test: by samples, by the steepest points that the derivation
/// of a constant meets, and on both sides of what may be a jump. Infinite sides are sampled up to 10 units from the
/// origin. Gives how many operations the derivation took too.
pub fn refute(graph: &Graph, claimed: f64, region: Bounds) -> (Claim, u64) {
    const MOST: u64 = 4096;
    // Large graphs get fewer samples, so that this takes no longer than the derivation of a constant.
    let samples = (MAX_WORK / graph.work().max(1)).clamp(1, MOST);
    let everywhere = match region.is_finite() {
        true => gradient_bound(graph, region),
        false => lipschitz_of_graph(graph, region),
    };
    let is_whole = region.is_finite();
    let region = searched(region);
    if region.is_empty() || everywhere <= claimed {
        return (Claim::Derived(everywhere), 0);
    }
    // A part in 10^9 is rounding, not a refutation.
    let refutes = |r: &Refutation| r.slope.is_finite() && r.slope > claimed * (1.0 + 1e-9);
    let sampled = (0..samples)
        .map(|i| steepness(graph, sample(&region, i)))
        .filter(refutes)
        .max_by(|a, b| a.slope.total_cmp(&b.slope));
    if let Some(found) = sampled {
        return (Claim::Refuted(found), 0);
    }
    let found = derive(graph, region, of_terms(graph, region));
    let effort = found.boxes as u64 * graph.work();
    if refutes(&found.steepest) {
        return (Claim::Refuted(found.steepest), effort);
    }
    let jump = (found.bound == f64::INFINITY)
        .then(|| jump(graph, region, claimed))
        .flatten();
    match jump {
        Some(point) => (Claim::Jumps(point), effort),
        None if is_whole => (Claim::Derived(found.bound), effort),
        None => (Claim::Nearby(everywhere), effort),
    }
}

/// A place that may be a jump, between two points around which the value does change by more than `claimed` allows.
fn jump(graph: &Graph, region: Bounds, claimed: f64) -> Option<[f64; 3]> {
    let Trouble { point, .. } = trouble(graph, region)?;
    let reach = 1e-6 * (1.0 + region.radius());
    let value = |p: [f64; 3]| graph.value(&Vec3::<f64>::splat(p));
    let is_jump = |axis: usize| {
        let (mut before, mut behind) = (point, point);
        before[axis] -= reach;
        behind[axis] += reach;
        let slope = (value(behind) - value(before)).abs() / (2.0 * reach);
        // Rounding of the values is far below a tenth of what a slope of `claimed` makes over such a distance.
        slope.is_finite() && slope > 1.1 * claimed
    };
    (0..3).any(is_jump).then_some(point)
}

/// Point number `i` of a sequence that fills the box evenly. Source: Roberts 2018, R3 sequence.
pub(super) fn sample(region: &Bounds, i: u64) -> [f64; 3] {
    const STEP: [f64; 3] = [
        0.819_172_513_396_164_5,
        0.671_043_606_703_789_2,
        0.549_700_477_901_970_3,
    ];
    std::array::from_fn(|axis| {
        let u = (0.5 + STEP[axis] * (i + 1) as f64).fract();
        region.low[axis] + u * (region.high[axis] - region.low[axis])
    })
}

/// A part of the region with a bound of the slope there.
#[derive(Clone, Copy, Debug)]
struct Cell {
    bound: f64,
    region: Bounds,
}

/// A box cut across its longest side, at this share of it.
fn halves(region: &Bounds, share: f64) -> [Bounds; 2] {
    let size = region.size();
    let axis = (0..3)
        .max_by(|a, b| size[*a].total_cmp(&size[*b]))
        .unwrap_or(0);
    let cut = region.low[axis] + share * size[axis];
    let (mut below, mut above) = (*region, *region);
    below.high[axis] = cut;
    above.low[axis] = cut;
    [below, above]
}

impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Cell {}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Cell {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.bound.total_cmp(&other.bound)
    }
}
