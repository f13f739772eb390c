//! Combinations that can be thinned out: in a small ball most children of a combination have no say.
//!
//! A child's field changes by at most its Lipschitz constant times the radius over a ball, so one value at the centre
//! gives its range there. Where a child of a union surely lies above the others by the width of the blend, the union is
//! the same without it, to the bit, at every point of the ball; and so with signs for intersections and differences.
//! Sources: the value rule of Barbier et al. 2025, with the constant of each child instead of 1; ranges as in Keeter 2025.

use super::{Closure, Level, combine, compile_convex, compile_wide};
use crate::catalogue::{Combination, Operation, with_compiled_blend};
use crate::num::{Dual, F64x32, Number, Vec3};
use crate::scene::{Node, Shape};
use std::sync::Arc;

/// The field of a combination, by its leaves.
pub struct Thicket {
    root: Branch,
    leaves: Vec<Leaf>,
    level: Level,
}

/// What is not taken apart any further.
struct Leaf {
    value: Closure<F64x32>,
    slope: Option<Closure<Dual<F64x32, 1>>>,
    lipschitz: f64,
}

/// A tree of combinations over leaves, by number.
#[derive(Clone, Debug, PartialEq)]
enum Branch {
    Leaf(usize),
    Join(Arc<Combination>, Vec<Branch>),
}

/// The values that a field takes in a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// At least this.
    pub low: f64,
    /// At most this.
    pub high: f64,
}

impl Reach {
    /// The numbers with their signs turned.
    fn negated(self) -> Self {
        Self {
            low: -self.high,
            high: -self.low,
        }
    }
}

/// What is left of a thicket in a ball.
#[derive(Clone, Debug, PartialEq)]
pub struct Thinned {
    branch: Branch,
    /// The values there.
    pub reach: Reach,
    /// How many leaves are left.
    pub leaves: usize,
}

impl Thinned {
    /// Whether the same leaves are left in the same places.
    pub fn is_same(&self, other: &Self) -> bool {
        self.branch == other.branch
    }
}

impl Thicket {
    /// The thicket of a combination, with constants of its leaves from `lipschitz`; none for what has too few leaves to
    /// be worth it.
    pub fn new(node: &Node, level: Level, lipschitz: &dyn Fn(&Node) -> f64) -> Option<Self> {
        let mut leaves = Vec::new();
        let root = branch(node, &mut |leaf| {
            leaves.push(Leaf {
                value: compile_wide(leaf, level),
                slope: (!node.has_graph()).then(|| compile_convex(leaf, level)),
                lipschitz: lipschitz(leaf),
            });
            leaves.len() - 1
        });
        let is_worth_it = leaves.len() >= Self::FEWEST;
        is_worth_it.then_some(Self {
            root,
            leaves,
            level,
        })
    }

    /// Thickets with fewer leaves are evaluated whole.
    const FEWEST: usize = 3;

    /// How many leaves there are.
    pub fn leaves(&self) -> usize {
        self.leaves.len()
    }

    /// The values of all leaves at 32 points.
    pub fn values(&self, points: &Vec3<F64x32>) -> Vec<F64x32> {
        self.leaves
            .iter()
            .map(|leaf| (leaf.value)(points))
            .collect()
    }

    /// The field at these points, from the [`Thicket::values`] of its leaves.
    pub fn joined(&self, values: &[F64x32]) -> F64x32 {
        joined(&self.root, values)
    }

    /// What is left in the ball about point `lane` of those that `values` were taken at, with `radius`; `noise` is how
    /// much of a value may be rounding.
    pub fn thinned(&self, values: &[F64x32], lane: usize, radius: f64, noise: f64) -> Thinned {
        let reach = |leaf: usize| {
            let room = self.leaves[leaf].lipschitz * radius * (1.0 + 1e-9) + noise;
            let value = values[leaf].0[lane];
            Reach {
                low: value - room,
                high: value + room,
            }
        };
        let (branch, reach) = thinned(&self.root, &reach);
        let leaves = count(&branch);
        Thinned {
            branch,
            reach,
            leaves,
        }
    }

    /// The closure of what is left.
    pub fn value(&self, left: &Thinned) -> Closure<F64x32> {
        self.closure(&left.branch, &|leaf| self.leaves[leaf].value.clone())
    }

    /// The closure of what is left, with the derivative along a direction; none for fields with graphs.
    pub fn slope(&self, left: &Thinned) -> Option<Closure<Dual<F64x32, 1>>> {
        let leaf = |leaf: usize| {
            let slope = self.leaves[leaf].slope.as_ref();
            slope
                .cloned()
                .expect("either all leaves have slopes or none")
        };
        self.leaves[0].slope.as_ref()?;
        Some(self.closure(&left.branch, &leaf))
    }

    fn closure<N: Number>(
        &self,
        branch: &Branch,
        leaf: &dyn Fn(usize) -> Closure<N>,
    ) -> Closure<N> {
        match branch {
            Branch::Leaf(number) => leaf(*number),
            Branch::Join(combination, children) => {
                let children = children.iter().map(|c| self.closure(c, leaf)).collect();
                combine(combination, children, self.level)
                    .expect("a thicket has compiled blends alone")
            }
        }
    }
}

/// The tree of a node; `leaf` numbers what is not taken apart.
fn branch(node: &Node, leaf: &mut dyn FnMut(&Node) -> usize) -> Branch {
    match node.shape() {
        Shape::Combination(combination, children) if can_thin(combination) => Branch::Join(
            Arc::new(combination.clone()),
            children.iter().map(|child| branch(child, leaf)).collect(),
        ),
        _ => Branch::Leaf(leaf(node)),
    }
}

/// Whether the children of a combination can lose their say.
fn can_thin(combination: &Combination) -> bool {
    let is_compiled = with_compiled_blend!(&combination.blend, _blend => true).unwrap_or(false);
    let has_width = combination.blend.width().is_some();
    is_compiled && has_width && combination.operation != Operation::Joint
}

fn count(branch: &Branch) -> usize {
    match branch {
        Branch::Leaf(_) => 1,
        Branch::Join(_, children) => children.iter().map(count).sum(),
    }
}

fn joined(branch: &Branch, values: &[F64x32]) -> F64x32 {
    match branch {
        Branch::Leaf(number) => values[*number],
        Branch::Join(combination, children) => {
            let children = children.iter().map(|child| joined(child, values));
            children
                .reduce(|a, b| join(combination, a, b))
                .expect("a combination has children")
        }
    }
}

fn join<N: Number>(combination: &Combination, a: N, b: N) -> N {
    with_compiled_blend!(&combination.blend, blend => combination.operation.join(blend, a, b))
        .expect("a thicket has compiled blends alone")
}

/// What is left of a branch where its leaves have these reaches, and its own.
fn thinned(branch: &Branch, reach: &dyn Fn(usize) -> Reach) -> (Branch, Reach) {
    let (combination, children) = match branch {
        Branch::Leaf(number) => return (branch.clone(), reach(*number)),
        Branch::Join(combination, children) => (combination, children),
    };
    let width = combination.blend.width().unwrap_or(f64::INFINITY);
    let (first, mut all) = thinned(&children[0], reach);
    let mut kept = vec![first];
    for child in &children[1..] {
        let (child, own) = thinned(child, reach);
        match standing(combination.operation, all, own, width) {
            Standing::Silent => {}
            Standing::Alone => {
                kept.clear();
                kept.push(child);
                all = own;
            }
            Standing::Mixed => {
                kept.push(child);
                all = joined_reach(combination, all, own);
            }
        }
    }
    match <[Branch; 1]>::try_from(kept) {
        Ok([only]) => (only, all),
        Err(kept) => (Branch::Join(combination.clone(), kept), all),
    }
}

/// What a further child of a combination does to what the ones before it gave.
enum Standing {
    /// Nothing.
    Silent,
    /// It takes their place.
    Alone,
    /// It depends on the point.
    Mixed,
}

/// The standing of a child with the reach `own` beside `all` before it.
fn standing(operation: Operation, all: Reach, own: Reach, width: f64) -> Standing {
    // As a union: whose smallest value is above the other's largest has no say.
    let (all, own) = match operation {
        Operation::Union | Operation::Joint => (all, own),
        Operation::Intersection => (all.negated(), own.negated()),
        Operation::Difference => (all.negated(), own),
    };
    if own.low > all.high + width {
        Standing::Silent
    } else if own.high + width < all.low && operation != Operation::Difference {
        Standing::Alone
    } else {
        Standing::Mixed
    }
}

/// The reach of a combination of two fields: it rises with both, or falls with what is subtracted.
fn joined_reach(combination: &Combination, a: Reach, b: Reach) -> Reach {
    let b = match combination.operation {
        Operation::Difference => Reach {
            low: b.high,
            high: b.low,
        },
        _ => b,
    };
    // Room for the rounding of the join itself.
    let room = |x: f64| 8.0 * f64::EPSILON * x.abs();
    let (low, high) = (
        join(combination, a.low, b.low),
        join(combination, a.high, b.high),
    );
    Reach {
        low: low - room(low),
        high: high + room(high),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{AnyBlend, AnyModifier, AnyPrimitive, Smooth, Sphere, Translate};
    use crate::num::Lanes;
    use crate::num::samples::random;

    fn place(seed: u64, size: f64) -> [f64; 3] {
        [0, 1, 2].map(|k| size * (2.0 * random(seed * 3 + k) - 1.0))
    }

    fn ball(seed: u64) -> Arc<Node> {
        let sphere = Sphere::new(0.1 + 0.4 * random(seed));
        let node = Node::primitive(AnyPrimitive::Sphere(sphere)).unwrap();
        let shift = AnyModifier::Translate(Translate::new(place(seed + 99, 2.0)));
        Node::modifier(shift, node).unwrap()
    }

    fn combined(operation: Operation, width: f64, nodes: Vec<Arc<Node>>) -> Arc<Node> {
        let blend = AnyBlend::Smooth(Smooth::new(width)).simplified();
        Node::combination(Combination { operation, blend }, nodes).unwrap()
    }

    /// A tree of all operations, hard and smooth.
    fn tree(seed: u64) -> Arc<Node> {
        let operations = [
            Operation::Union,
            Operation::Intersection,
            Operation::Difference,
        ];
        let branch = |k: u64| {
            let width = if k.is_multiple_of(2) { 0.0 } else { 0.3 };
            let balls = (0..6).map(|i| ball(seed * 100 + k * 10 + i)).collect();
            combined(operations[(seed + k) as usize % 3], width, balls)
        };
        let first = operations[seed as usize % 3];
        combined(first, 0.2, (0..4).map(branch).collect())
    }

    #[test]
    fn what_is_left_has_the_bits_of_the_whole() {
        let (mut left, mut all) = (0, 0);
        for seed in 0..60 {
            let node = tree(seed);
            let thicket = Thicket::new(&node, Level::best(), &|leaf| leaf.lipschitz()).unwrap();
            let whole = compile_wide::<F64x32>(&node, Level::best());
            let centres: Vec<[f64; 3]> = (0..32).map(|k| place(seed * 64 + k, 2.5)).collect();
            let axis = |axis: usize| Lanes::from_fn(|lane| centres[lane][axis]);
            let points = Vec3::new(axis(0), axis(1), axis(2));
            let values = thicket.values(&points);
            assert_eq!(thicket.joined(&values), whole(&points));
            for (lane, centre) in centres.iter().enumerate() {
                let radius = 0.6 * random(seed + lane as u64);
                let thinned = thicket.thinned(&values, lane, radius, 1e-12);
                (left, all) = (left + thinned.leaves, all + thicket.leaves());
                let inside = |k: usize, axis: usize| {
                    let way = place(seed * 1000 + k as u64, 1.0);
                    let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
                    centre[axis] + way[axis] / length * radius * random(k as u64)
                };
                let axis = |axis: usize| Lanes::from_fn(|k| inside(k, axis));
                let places = Vec3::new(axis(0), axis(1), axis(2));
                let (expected, found) = (whole(&places), thicket.value(&thinned)(&places));
                assert_eq!(expected, found, "seed {seed}");
                let Reach { low, high } = thinned.reach;
                assert!(expected.0.iter().all(|x| low <= *x && *x <= high));
                let rate = |x: F64x32| Dual::new(x, [Lanes([0.6; 32])]);
                let moving = Vec3::new(rate(places.x), rate(places.y), rate(places.z));
                let slope = thicket.slope(&thinned).expect("no graphs")(&moving);
                let expected = compile_convex(&node, Level::best())(&moving);
                assert_eq!(slope.partial[0], expected.partial[0], "seed {seed}");
            }
        }
        assert!(3 * left < 2 * all, "{left} of {all} leaves are left");
    }
}
