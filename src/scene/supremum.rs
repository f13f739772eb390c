//! The steepest slope that sampling finds: what a Lipschitz constant is compared with.

use super::Node;
use super::derive::{sample, searched};
use crate::catalogue::Bounds;
use crate::num::{Dual, Vec3};

/// The largest gradient of `node` at `samples` points of `region` (infinite sides up to 10 units from the origin) and at
/// as many next to the steepest of them, each half as far as the one before: at most the true supremum. None where no
/// gradient is finite.
pub fn sampled_supremum(node: &Node, region: Bounds, samples: u64) -> Option<f64> {
    let region = searched(region);
    if region.is_empty() {
        return None;
    }
    let slope = |p: [f64; 3]| {
        let [x, y, z] = std::array::from_fn(|i| Dual::<f64, 3>::variable(p[i], i));
        let field = node.evaluate(&Vec3::new(x, y, z));
        let slope = field.partial.iter().fold(0.0, |n: f64, d| n.hypot(*d));
        (slope, p)
    };
    let steeper = |a: (f64, [f64; 3]), b: (f64, [f64; 3])| if b.0 > a.0 { b } else { a };
    let spread = (0..samples)
        .map(|i| slope(sample(&region, i)))
        .filter(|(slope, _)| slope.is_finite())
        .reduce(steeper)?;
    let mut best = spread;
    for round in 0..CLIMBS {
        let reach = region.size().map(|side| side * 0.5f64.powi(round + 2));
        let [a, b] = [best.1, best.1];
        let near = Bounds::new(
            std::array::from_fn(|i| (a[i] - reach[i]).max(region.low[i])),
            std::array::from_fn(|i| (b[i] + reach[i]).min(region.high[i])),
        );
        let found = (0..samples / CLIMBS as u64 + 1)
            .map(|i| slope(sample(&near, i)))
            .filter(|(slope, _)| slope.is_finite())
            .reduce(steeper);
        best = found.map_or(best, |found| steeper(best, found));
    }
    Some(best.0)
}

/// How often the search closes in on the steepest point.
const CLIMBS: i32 = 16;
