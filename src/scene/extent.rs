//! How far the solid of a user's field reaches, by ranges of the field over half-spaces and slabs.

use super::Graph;
use super::derive::range_of_graph;
use crate::catalogue::Bounds;

/// How many operations of the graph the search for one box may take.
const MAX_WORK: u64 = 1 << 19;

/// Sides are looked for from 2^-20 to 2^20 scene units from the origin.
const OCTAVES: std::ops::RangeInclusive<i32> = -20..=20;

/// How often a side is moved half way in.
const HALVINGS: usize = 10;

/// A box that holds every point where the graph's first output is at most `level`, and how many regions were looked at.
/// A side is infinite where ranges cannot show that the solid ends.
pub(super) fn extent(graph: &Graph, level: f64) -> (Bounds, usize) {
    let mut search = Search {
        graph,
        level,
        looks: 0,
    };
    let most = MAX_WORK / graph.work().max(1);
    let mut bounds = Bounds::EVERYWHERE;
    // What one axis shows narrows the regions of the next; twice round is enough.
    for _ in 0..2 {
        let before = bounds;
        for axis in 0..3 {
            search.cut(&mut bounds, axis, most);
        }
        if bounds == before {
            break;
        }
    }
    if !bounds.is_finite() {
        return (bounds, search.looks);
    }
    for _ in 0..HALVINGS {
        for axis in 0..3 {
            search.shave(&mut bounds, axis, most);
        }
    }
    (bounds, search.looks)
}

struct Search<'a> {
    graph: &'a Graph,
    level: f64,
    looks: usize,
}

impl Search<'_> {
    /// Whether the field is above the level everywhere in `region`.
    fn is_clear(&mut self, region: &Bounds) -> bool {
        self.looks += 1;
        range_of_graph(self.graph, *region).lo > self.level
    }

    /// Cuts off the half-spaces across `axis` that are clear, where a side is still infinite.
    fn cut(&mut self, bounds: &mut Bounds, axis: usize, most: u64) {
        if bounds.high[axis].is_infinite() {
            let beyond = |r: f64| {
                let mut region = *bounds;
                region.low[axis] = region.low[axis].max(r);
                region
            };
            if let Some(r) = self.least(beyond, most) {
                bounds.high[axis] = r.max(bounds.low[axis]);
            }
        }
        if bounds.low[axis].is_infinite() {
            let beyond = |r: f64| {
                let mut region = *bounds;
                region.high[axis] = region.high[axis].min(-r);
                region
            };
            if let Some(r) = self.least(beyond, most) {
                bounds.low[axis] = (-r).min(bounds.high[axis]);
            }
        }
    }

    /// The least power of 2 beyond which the half-space is clear: the further out it begins, the smaller it is.
    fn least(&mut self, beyond: impl Fn(f64) -> Bounds, most: u64) -> Option<f64> {
        let (mut low, mut high) = (*OCTAVES.start(), *OCTAVES.end());
        if self.looks + 8 > most as usize || !self.is_clear(&beyond(2.0f64.powi(high))) {
            return None;
        }
        while low < high {
            let middle = (low + high).div_euclid(2);
            if self.is_clear(&beyond(2.0f64.powi(middle))) {
                high = middle;
            } else {
                low = middle + 1;
            }
        }
        Some(2.0f64.powi(high))
    }

    /// Cuts off the clear half or quarter of a finite box, on either side of `axis`.
    fn shave(&mut self, bounds: &mut Bounds, axis: usize, most: u64) {
        for share in [0.5, 0.125, 0.03125] {
            let step = share * (bounds.high[axis] - bounds.low[axis]);
            let mut upper = *bounds;
            upper.low[axis] = bounds.high[axis] - step;
            if self.looks < most as usize && self.is_clear(&upper) {
                bounds.high[axis] = upper.low[axis];
            }
            let mut lower = *bounds;
            lower.high[axis] = bounds.low[axis] + step;
            if self.looks < most as usize && self.is_clear(&lower) {
                bounds.low[axis] = lower.high[axis];
            }
        }
    }
}
