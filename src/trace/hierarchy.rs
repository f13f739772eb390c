//! A hierarchy of boxes over the parts, so that a ray asks only those that it can meet.
//!
//! Each node has up to eight boxes, which are asked at once. Sources: Wald 2007, binned building by the surface area
//! heuristic, here with the median of the longest axis, which is within a few per cent for the even distributions that
//! scripts make; Wald, Benthin and Boulos 2008 for wide nodes.

use crate::catalogue::Bounds;
use glam::DVec3;
use std::ops::ControlFlow;

/// How many boxes a node has: as many as lanes ask at once.
pub(super) const BRANCHES: usize = super::bits::LANES;

/// A number for each box of a node.
pub(super) type Eight = [f64; BRANCHES];

/// The boxes of a node, side by side: their low and high corners, by axis. Those that are not there are empty.
#[derive(Clone, Copy, Debug)]
pub(super) struct Boxes {
    pub low: [Eight; 3],
    pub high: [Eight; 3],
}

impl Boxes {
    /// Up to 8 boxes.
    pub fn new(bounds: impl Iterator<Item = Bounds>) -> Self {
        let mut boxes = Self {
            low: [[f64::INFINITY; BRANCHES]; 3],
            high: [[f64::NEG_INFINITY; BRANCHES]; 3],
        };
        for (k, bounds) in bounds.take(BRANCHES).enumerate() {
            for axis in 0..3 {
                boxes.low[axis][k] = bounds.low[axis];
                boxes.high[axis][k] = bounds.high[axis];
            }
        }
        boxes
    }

    /// Box number `k`.
    pub fn at(&self, k: usize) -> Bounds {
        Bounds {
            low: [0, 1, 2].map(|axis| self.low[axis][k]),
            high: [0, 1, 2].map(|axis| self.high[axis][k]),
        }
    }
}

/// A part's number and its box.
type Item = (u32, Bounds);

/// A node: boxes around parts, or around nodes.
pub(super) struct Node {
    /// The boxes.
    pub boxes: Boxes,
    /// The number of the part, or the node, in each of them.
    pub inside: [u32; BRANCHES],
    /// How many there are.
    pub count: usize,
    /// Whether they hold parts.
    pub has_parts: bool,
}

/// The hierarchy.
#[derive(Default)]
pub(super) struct Hierarchy {
    /// The first is the root.
    nodes: Vec<Node>,
}

impl Hierarchy {
    /// The hierarchy over finite boxes, each with its part's number.
    pub fn new(boxes: &[Item]) -> Self {
        let mut items: Vec<Item> = boxes
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

    /// The root's number; none where there is nothing.
    pub fn root(&self) -> Option<u32> {
        (!self.nodes.is_empty()).then_some(0)
    }

    /// A node by its number.
    pub fn node(&self, number: u32) -> &Node {
        &self.nodes[number as usize]
    }

    /// Adds a node over these parts; gives its number.
    fn build(&mut self, items: &mut [Item]) -> u32 {
        let here = self.nodes.len();
        // As many as a branch can hold below which every node is full.
        let mut room = 1;
        while BRANCHES * room < items.len() {
            room *= BRANCHES;
        }
        let mut groups = vec![items];
        // The largest is halved until there are as many as boxes, or all are small enough.
        while groups.len() < BRANCHES {
            let largest = (0..groups.len())
                .max_by_key(|k| groups[*k].len())
                .unwrap_or(0);
            if groups[largest].len() <= room {
                break;
            }
            let items = groups.swap_remove(largest);
            groups.extend(halves(items, room));
        }
        let hulls = groups.iter().map(|items| {
            let boxes = items.iter().map(|(_, bounds)| *bounds);
            boxes.fold(Bounds::EMPTY, Bounds::hull)
        });
        self.nodes.push(Node {
            boxes: Boxes::new(hulls),
            inside: [0; BRANCHES],
            count: groups.len(),
            has_parts: room == 1,
        });
        for (k, group) in groups.into_iter().enumerate() {
            self.nodes[here].inside[k] = if room == 1 {
                group[0].0
            } else {
                self.build(group)
            };
        }
        here as u32
    }

    /// Calls `visit` with every part whose box `enters` finds met, and with where: it gives for each box of a node where that
    /// is entered, infinite if it is not. Ends where `visit` says so, and gives whether it did.
    #[inline(always)]
    pub fn visit(
        &self,
        enters: impl Fn(&Boxes) -> Eight,
        mut visit: impl FnMut(u32, f64) -> ControlFlow<()>,
    ) -> bool {
        let mut open: Vec<u32> = Vec::with_capacity(64);
        open.extend(self.root());
        while let Some(number) = open.pop() {
            let node = self.node(number);
            let entered = enters(&node.boxes);
            for (inside, enter) in node.inside.iter().zip(entered).take(node.count) {
                if enter == f64::INFINITY {
                    continue;
                }
                if !node.has_parts {
                    open.push(*inside);
                } else if visit(*inside, enter).is_break() {
                    return true;
                }
            }
        }
        false
    }
}

/// Some parts, divided in about half along the longest axis of their centres: the first of them fill branches with `room` for so
/// many. There are more than that.
fn halves(items: &mut [Item], room: usize) -> [&mut [Item]; 2] {
    let centres = Bounds::around(items.iter().map(|(_, b)| b.centre()));
    let size = centres.size();
    let axis = (0..3)
        .max_by(|a, b| size[*a].total_cmp(&size[*b]))
        .unwrap_or(0);
    let full = items.len().div_ceil(2).next_multiple_of(room);
    let middle = full.min(items.len() - 1);
    items.select_nth_unstable_by(middle, |(i, a), (j, b)| {
        a.centre()[axis].total_cmp(&b.centre()[axis]).then(i.cmp(j))
    });
    let (first, second) = items.split_at_mut(middle);
    [first, second]
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
#[inline(always)]
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::samples::random;

    #[test]
    fn every_part_is_in_one_box_and_nodes_are_full() {
        for n in [1, 2, 7, 8, 9, 63, 64, 65, 300, 512, 513, 5000] {
            let place = |k: u64| [0, 1, 2].map(|axis| random(3 * k + axis));
            let bounds = |k: u32| Bounds::centred([0.01; 3]).translate(place(u64::from(k)));
            let items: Vec<Item> = (0..n).map(|k| (k, bounds(k))).collect();
            let hierarchy = Hierarchy::new(&items);
            let mut found = Vec::new();
            let is_cut = hierarchy.visit(
                |_| [0.0; BRANCHES],
                |part, _| {
                    found.push(part);
                    ControlFlow::Continue(())
                },
            );
            assert!(!is_cut);
            let mut first = 0;
            let stop = |_, _| {
                first += 1;
                ControlFlow::Break(())
            };
            assert!(hierarchy.visit(|_| [0.0; BRANCHES], stop) && first == 1);
            found.sort_unstable();
            assert_eq!(found, (0..n).collect::<Vec<_>>());
            let with_parts = hierarchy.nodes.iter().filter(|node| node.has_parts);
            assert_eq!(with_parts.count(), n.div_ceil(BRANCHES as u32) as usize);
            for node in &hierarchy.nodes {
                for k in 0..node.count {
                    let boxes = node.boxes.at(k);
                    let number = node.inside[k];
                    let inner = if node.has_parts {
                        bounds(number)
                    } else {
                        let below = hierarchy.node(number);
                        (0..below.count)
                            .map(|k| below.boxes.at(k))
                            .fold(Bounds::EMPTY, Bounds::hull)
                    };
                    assert_eq!(boxes, inner, "{n}");
                }
            }
        }
    }
}
