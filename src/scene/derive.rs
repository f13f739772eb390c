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
fn slope_at(graph: &Graph, p: [f64; 3]) -> f64 {
    let [x, y, z] = std::array::from_fn(|i| Dual::variable(p[i], i));
    let field: Dual<f64, 3> = graph.value(&Vec3::new(x, y, z));
    field.partial.iter().fold(0.0, |n: f64, d| n.hypot(*d))
}

/// A Lipschitz constant of the graph's first output on `region`: the largest gradient, at most 3 % above it where
/// a budget of 32 768 boxes allows; infinite where none is known.
pub fn lipschitz_of_graph(graph: &Graph, region: Bounds) -> f64 {
    if region.is_empty() {
        return 0.0;
    }
    let region = one_period(region, graph.periods());
    if !region.is_finite() {
        return gradient_bound(graph, region);
    }
    let slack = SLACK * region.radius();
    graph.remembered(region, slack, |region| {
        derived(graph, region, of_terms(graph, region))
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

/// The constant on a finite region where `most_steep` is one already, and how many boxes were looked at.
fn derived(graph: &Graph, region: Bounds, most_steep: f64) -> (f64, usize) {
    let first = Cell {
        bound: gradient_bound(graph, region).min(most_steep),
        region,
    };
    let most = (MAX_WORK / graph.work().max(1)).clamp(1, MAX_BOXES as u64) as usize;
    let mut steepest = slope_at(graph, region.centre());
    let mut cells = BinaryHeap::from([first]);
    // The cell with the largest bound is cut in half until what it says is nearly attained.
    while cells.len() < most {
        let top = cells.peek().expect("the region's cells cover it").bound;
        if top <= steepest * ENOUGH {
            break;
        }
        let cell = cells.pop().expect("peeked just now");
        let halves = halves(&cell.region, 0.5);
        if halves.iter().any(|half| half.size() == cell.region.size()) {
            cells.push(cell);
            break;
        }
        for half in halves {
            let slope = slope_at(graph, half.centre());
            if slope.is_finite() {
                steepest = steepest.max(slope);
            }
            cells.push(Cell {
                bound: gradient_bound(graph, half).min(cell.bound),
                region: half,
            });
        }
    }
    let bound = cells.peek().map_or(f64::INFINITY, |cell| cell.bound);
    (bound, cells.len())
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

/// A point in `region` where the field is steeper than `claimed`, if sampling finds one. Infinite sides are sampled up
/// to 10 units from the origin.
pub fn refute(graph: &Graph, claimed: f64, region: Bounds) -> Option<Refutation> {
    const MOST: u64 = 4096;
    // Large graphs get fewer samples, so that this takes no longer than the derivation of a constant.
    let samples = (MAX_WORK / graph.work().max(1)).clamp(1, MOST);
    let region = searched(region);
    if region.is_empty() || gradient_bound(graph, region) <= claimed {
        return None;
    }
    let steepest = (0..samples)
        .map(|i| {
            let point = sample(&region, i);
            Refutation {
                point,
                slope: slope_at(graph, point),
            }
        })
        .filter(|r| r.slope.is_finite())
        .max_by(|a, b| a.slope.total_cmp(&b.slope))?;
    // A part in 10^9 is rounding, not a refutation.
    (steepest.slope > claimed * (1.0 + 1e-9)).then_some(steepest)
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
