//! A hierarchy of boxes over the parts, so that a ray asks only those that it can meet.
//!
//! Source: Wald 2007, binned building by the surface area heuristic, here with the median of the longest axis, which is
//! within a few per cent for the even distributions that scripts make.

use crate::catalogue::Bounds;
use glam::DVec3;

/// How many parts a leaf holds at most.
const LEAF: usize = 4;

/// A node: a leaf with some of the parts, or two children, the first of which follows it.
struct Branch {
    bounds: Bounds,
    /// A leaf's first part in the order, or the number of the second child.
    start: u32,
    /// A leaf's number of parts; 0 for a node with children.
    count: u32,
}

/// The hierarchy.
#[derive(Default)]
pub(super) struct Hierarchy {
    branches: Vec<Branch>,
    order: Vec<u32>,
}

impl Hierarchy {
    /// The hierarchy over finite boxes, each with its part's number.
    pub fn new(boxes: &[(u32, Bounds)]) -> Self {
        let mut items: Vec<(u32, Bounds)> = boxes
            .iter()
            .filter(|(_, b)| !b.is_empty())
            .copied()
            .collect();
        let mut hierarchy = Self::default();
        if !items.is_empty() {
            hierarchy.build(&mut items);
        }
        hierarchy
    }

    fn build(&mut self, items: &mut [(u32, Bounds)]) {
        let bounds = items
            .iter()
            .fold(Bounds::EMPTY, |b, (_, item)| b.hull(*item));
        let here = self.branches.len();
        let count = if items.len() <= LEAF {
            items.len() as u32
        } else {
            0
        };
        self.branches.push(Branch {
            bounds,
            start: self.order.len() as u32,
            count,
        });
        if count > 0 {
            self.order.extend(items.iter().map(|(part, _)| *part));
            return;
        }
        let centres = Bounds::around(items.iter().map(|(_, b)| b.centre()));
        let size = centres.size();
        let axis = (0..3)
            .max_by(|a, b| size[*a].total_cmp(&size[*b]))
            .unwrap_or(0);
        let middle = items.len() / 2;
        items.select_nth_unstable_by(middle, |(i, a), (j, b)| {
            a.centre()[axis].total_cmp(&b.centre()[axis]).then(i.cmp(j))
        });
        let (first, second) = items.split_at_mut(middle);
        self.build(first);
        self.branches[here].start = self.branches.len() as u32;
        self.build(second);
    }

    /// Calls `visit` with every part of the leaves whose boxes `enters` finds met, and with what it gave for the leaf: where
    /// that is entered.
    pub fn visit(&self, enters: impl Fn(&Bounds) -> Option<f64>, mut visit: impl FnMut(u32, f64)) {
        if self.branches.is_empty() {
            return;
        }
        let mut stack = [0u32; 64];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let here = stack[height] as usize;
            let branch = &self.branches[here];
            let Some(enter) = enters(&branch.bounds) else {
                continue;
            };
            if branch.count > 0 {
                let start = branch.start as usize;
                let parts = &self.order[start..start + branch.count as usize];
                parts.iter().for_each(|part| visit(*part, enter));
                continue;
            }
            for child in [branch.start, here as u32 + 1] {
                stack[height] = child;
                height += 1;
            }
        }
    }
}

/// Where a ray is inside of a box, from 0 to `limit`, given the reciprocals of its direction; a box that it only
/// touches counts. Source: Kay and Kajiya 1986, with the rounding bound of Ize 2013.
pub(super) fn clip(
    origin: DVec3,
    inverse: DVec3,
    bounds: &Bounds,
    limit: f64,
) -> Option<(f64, f64)> {
    let (mut enter, mut leave) = (0.0f64, limit);
    for axis in 0..3 {
        let (o, i) = (origin[axis], inverse[axis]);
        if i.is_infinite() {
            if o < bounds.low[axis] || o > bounds.high[axis] {
                return None;
            }
            continue;
        }
        let (a, b) = ((bounds.low[axis] - o) * i, (bounds.high[axis] - o) * i);
        let (near, far) = if a < b { (a, b) } else { (b, a) };
        enter = enter.max(near * (1.0 - 4.0 * f64::EPSILON));
        leave = leave.min(far * (1.0 + 4.0 * f64::EPSILON));
    }
    (enter <= leave).then_some((enter, leave))
}

/// Where a ray walks that is inside of a region from `enter` to `leave`, with room for the rounding of places along it;
/// `origin` is the largest coordinate of its own. A ray that ends at `t_max` goes no farther.
pub(super) fn stretch(origin: f64, enter: f64, leave: f64, t_max: f64) -> (f64, f64) {
    let slack = |t: f64| 32.0 * f64::EPSILON * (origin + t);
    let start = (enter - slack(enter)).max(0.0);
    let end = if leave == t_max {
        leave
    } else {
        leave + slack(leave)
    };
    (start, end)
}
