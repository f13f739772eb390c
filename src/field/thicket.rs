//! Combinations that can be thinned out: in a small ball most children of a combination have no say.
//!
//! A child's field changes by at most its Lipschitz constant times the radius over a ball, so one value at the centre
//! gives its range there. Where a child of a union surely lies above the others by the width of the blend, the union is
//! the same without it, to the bit, at every point of the ball; and so with signs for intersections and differences.
//! Sources: the value rule of Barbier et al. 2025, with the constant of each child instead of 1; ranges as in Keeter 2025.

use super::{Closure, Level, Task, combine, compile_convex, compile_wide, modify, place, run_at};
use crate::catalogue::with_compiled_blend;
use crate::catalogue::{AnyModifier, Bounds, Combination, Modifier, Operation, Similarity};
use crate::num::{Dual, F32x32, F64x16, F64x32, Number, Vec3};
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
    short: Closure<F32x32>,
    gradient: Option<Closure<Dual<F64x16, 3>>>,
    lipschitz: f64,
}

/// A tree of combinations, some of them placed or with changed values, over leaves, by number.
#[derive(Clone, Debug, PartialEq)]
enum Branch {
    Leaf(usize),
    Join(Arc<Combination>, Vec<Branch>),
    Placed(Similarity, Box<Branch>),
    /// By an offset or a shell, which change the values alone.
    Changed(Arc<AnyModifier>, Box<Branch>),
}

impl Branch {
    /// The number of its first leaf: leaves are numbered in order.
    fn first(&self) -> usize {
        match self {
            Self::Leaf(number) => *number,
            Self::Join(_, children) => children[0].first(),
            Self::Placed(_, child) | Self::Changed(_, child) => child.first(),
        }
    }

    /// The number behind its last leaf.
    fn end(&self) -> usize {
        match self {
            Self::Leaf(number) => number + 1,
            Self::Join(_, children) => children.last().map_or(0, Self::end),
            Self::Placed(_, child) | Self::Changed(_, child) => child.end(),
        }
    }
}

/// The values that a field takes in each of 32 balls.
#[derive(Clone, Copy, Debug)]
pub struct Reach {
    /// At least this.
    pub low: F64x32,
    /// At most this.
    pub high: F64x32,
}

impl Reach {
    /// The values in units that are `scale` times as small, with room for rounding.
    fn times(self, scale: f64) -> Self {
        let (mut low, mut high) = (self.low, self.high);
        for (low, high) in low.0.iter_mut().zip(&mut high.0) {
            *low = (*low * scale).next_down();
            *high = (*high * scale).next_up();
        }
        Self { low, high }
    }

    /// The numbers with their signs turned.
    #[inline(always)]
    fn negated(self) -> Self {
        Self {
            low: -self.high,
            high: -self.low,
        }
    }
}

/// What is left of a thicket in each of 32 balls.
pub struct Sifted {
    /// For each leaf the balls in which it has a say, a bit for each.
    says: Vec<u32>,
    /// The values there.
    pub reach: Reach,
}

impl Sifted {
    /// Whether the same leaves are left in two balls.
    pub fn is_same(&self, a: usize, b: usize) -> bool {
        self.says
            .iter()
            .all(|says| (says >> a ^ says >> b) & 1 == 0)
    }
}

/// What is left of a thicket in a ball.
#[derive(Clone, Debug, PartialEq)]
pub struct Thinned {
    branch: Branch,
}

impl Thinned {
    /// How many leaves are left.
    pub fn leaves(&self) -> usize {
        count(&self.branch)
    }
}

impl Thicket {
    /// The thicket of a combination, with constants of its leaves over what is asked of them in `region` from `lipschitz`;
    /// none for what has too few leaves to be worth it.
    pub fn new(
        node: &Node,
        level: Level,
        region: Bounds,
        lipschitz: &dyn Fn(&Node, Bounds) -> f64,
    ) -> Option<Self> {
        let mut leaves = Vec::new();
        let root = branch(node, region, &mut |leaf, region| {
            leaves.push(Leaf {
                value: compile_wide(leaf, level),
                short: compile_wide(leaf, level),
                gradient: (!node.has_graph()).then(|| compile_convex(leaf, level)),
                lipschitz: lipschitz(leaf, region),
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

    /// The same thicket with the constants of its leaves times a factor: for studies of what wrong ones do.
    pub fn with_constants_times(mut self, factor: f64) -> Self {
        for leaf in &mut self.leaves {
            leaf.lipschitz *= factor;
        }
        self
    }

    /// Thickets with fewer leaves are evaluated whole.
    const FEWEST: usize = 3;

    /// How many leaves there are.
    pub fn leaves(&self) -> usize {
        self.leaves.len()
    }

    /// The instructions that its closures were made with.
    pub fn level(&self) -> Level {
        self.level
    }

    /// The values of all leaves at 32 points.
    pub fn values(&self, points: &Vec3<F64x32>) -> Vec<F64x32> {
        let mut values = Vec::with_capacity(self.leaves.len());
        self.add_values(&self.root, points, &mut values);
        values
    }

    fn add_values(&self, branch: &Branch, points: &Vec3<F64x32>, values: &mut Vec<F64x32>) {
        match branch {
            Branch::Leaf(number) => values.push((self.leaves[*number].value)(points)),
            Branch::Join(_, children) => {
                for child in children {
                    self.add_values(child, points, values);
                }
            }
            Branch::Placed(map, child) => {
                let inside = run_at(self.level, Inside { map, points });
                self.add_values(child, &inside, values);
            }
            Branch::Changed(_, child) => self.add_values(child, points, values),
        }
    }

    /// The field at these points, from the [`Thicket::values`] of its leaves.
    pub fn joined(&self, values: &[F64x32]) -> F64x32 {
        joined(&self.root, values, self.level)
    }

    /// What is left in the balls about the points that `values` were taken at, with these `radii`; `noise` is how much of a
    /// value may be rounding.
    pub fn sifted(&self, values: &[F64x32], radii: &F64x32, noise: f64) -> Sifted {
        let mut says = vec![u32::MAX; self.leaves.len()];
        let reach = self.sift(&self.root, values, (radii, noise), &mut says);
        Sifted { says, reach }
    }

    /// Takes from `says` the leaves of a branch that have no say in balls of these radii, given the values of all leaves at
    /// their centres and how much of these may be rounding; gives its reach.
    fn sift(
        &self,
        branch: &Branch,
        values: &[F64x32],
        (radii, noise): (&F64x32, f64),
        says: &mut [u32],
    ) -> Reach {
        let (combination, children) = match branch {
            Branch::Leaf(number) => {
                let around = Around {
                    value: &values[*number],
                    radii,
                    lipschitz: self.leaves[*number].lipschitz,
                    noise,
                };
                return run_at(self.level, around);
            }
            Branch::Placed(map, child) => {
                let scale = map.scale;
                let inner = *radii * F64x32::splat((1.0 + 1e-9) / scale);
                let reach = self.sift(child, values, (&inner, noise / scale), says);
                return reach.times(scale);
            }
            Branch::Changed(modifier, child) => {
                let reach = self.sift(child, values, (radii, noise), says);
                return run_at(self.level, Range { modifier, reach });
            }
            Branch::Join(combination, children) => (combination, children),
        };
        let mut all = self.sift(&children[0], values, (radii, noise), says);
        for child in &children[1..] {
            let own = self.sift(child, values, (radii, noise), says);
            let standing = Standing {
                combination,
                own,
                all: &mut all,
            };
            let Silenced { own, others } = run_at(self.level, standing);
            says[child.first()..child.end()]
                .iter_mut()
                .for_each(|says| *says &= !own);
            says[branch.first()..child.first()]
                .iter_mut()
                .for_each(|says| *says &= !others);
        }
        all
    }

    /// What is left in ball `lane`.
    pub fn thinned(&self, sifted: &Sifted, lane: usize) -> Thinned {
        let has_say = |leaf: usize| sifted.says[leaf] >> lane & 1 == 1;
        let branch = left(&self.root, &has_say).expect("some leaf has a say");
        Thinned { branch }
    }

    /// The closure of what is left.
    pub fn value(&self, left: &Thinned) -> Closure<F64x32> {
        self.closure(&left.branch, &|leaf| self.leaves[leaf].value.clone())
    }

    /// The closure of what is left, in single precision.
    pub fn short(&self, left: &Thinned) -> Closure<F32x32> {
        self.closure(&left.branch, &|leaf| self.leaves[leaf].short.clone())
    }

    /// The closure of what is left, with its gradient; none for fields with graphs.
    pub fn gradient(&self, left: &Thinned) -> Option<Closure<Dual<F64x16, 3>>> {
        let leaf = |leaf: usize| {
            let gradient = self.leaves[leaf].gradient.as_ref();
            gradient
                .cloned()
                .expect("either all leaves have gradients or none")
        };
        self.leaves[0].gradient.as_ref()?;
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
            Branch::Placed(map, child) => place(self.closure(child, leaf), *map, self.level),
            Branch::Changed(modifier, child) => {
                modify(modifier, self.closure(child, leaf), self.level)
                    .expect("offsets and shells are compiled")
            }
        }
    }
}

/// The tree of a node that is asked in `region`; `leaf` numbers what is not taken apart, with what is asked of it.
fn branch(node: &Node, region: Bounds, leaf: &mut dyn FnMut(&Node, Bounds) -> usize) -> Branch {
    let (map, inner, inside) = node.unplaced_in(region);
    let inner = match inner.shape() {
        Shape::Combination(combination, children) if can_thin(combination) => {
            let children = children.iter().map(|child| branch(child, inside, leaf));
            Branch::Join(Arc::new(combination.clone()), children.collect())
        }
        Shape::Modifier(modifier, child) if is_change(modifier) && falls_apart(child) => {
            let child = branch(child, inside, leaf);
            Branch::Changed(Arc::new(modifier.clone()), Box::new(child))
        }
        _ => return Branch::Leaf(leaf(node, region)),
    };
    if map == Similarity::IDENTITY {
        inner
    } else {
        Branch::Placed(map, Box::new(inner))
    }
}

/// Whether a node is not a single leaf.
fn falls_apart(node: &Node) -> bool {
    match node.unplaced().1.shape() {
        Shape::Combination(combination, _) => can_thin(combination),
        Shape::Modifier(modifier, child) => is_change(modifier) && falls_apart(child),
        _ => false,
    }
}

/// Whether a modifier changes the values alone.
fn is_change(modifier: &AnyModifier) -> bool {
    matches!(modifier, AnyModifier::Offset(_) | AnyModifier::Shell(_))
}

/// What such a modifier makes of a value.
#[inline(always)]
fn changed(modifier: &AnyModifier, value: F64x32) -> F64x32 {
    let nowhere = Vec3::splat([0.0; 3]);
    match modifier {
        AnyModifier::Offset(offset) => offset.apply(&nowhere, |_| value),
        AnyModifier::Shell(shell) => shell.apply(&nowhere, |_| value),
        _ => value,
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
        Branch::Placed(_, child) | Branch::Changed(_, child) => count(child),
    }
}

fn joined(branch: &Branch, values: &[F64x32], level: Level) -> F64x32 {
    match branch {
        Branch::Leaf(number) => values[*number],
        Branch::Join(combination, children) => {
            let (first, rest) = children.split_first().expect("a combination has children");
            let mut all = joined(first, values, level);
            for child in rest {
                let own = joined(child, values, level);
                run_at(
                    level,
                    Joining {
                        combination,
                        all: &mut all,
                        own: &own,
                    },
                );
            }
            all
        }
        Branch::Placed(map, child) => {
            let value = &joined(child, values, level);
            run_at(level, Outside { map, value })
        }
        Branch::Changed(modifier, child) => {
            let value = &joined(child, values, level);
            run_at(level, Changing { modifier, value })
        }
    }
}

/// Changes values.
struct Changing<'a> {
    modifier: &'a AnyModifier,
    value: &'a F64x32,
}

impl Task for Changing<'_> {
    type Output = F64x32;

    #[inline(always)]
    fn run(self) -> F64x32 {
        changed(self.modifier, *self.value)
    }
}

/// Finds what changed values reach to.
struct Range<'a> {
    modifier: &'a AnyModifier,
    reach: Reach,
}

impl Task for Range<'_> {
    type Output = Reach;

    #[inline(always)]
    fn run(self) -> Reach {
        let Reach { mut low, mut high } = self.reach;
        if matches!(self.modifier, AnyModifier::Shell(_)) {
            let (least, most) = (low.abs().min(high.abs()), low.abs().max(high.abs()));
            let zero = F64x32::splat(0.0);
            // Where both signs are there, so is zero.
            low = F64x32::select_lt(low * high, zero, zero, least);
            high = most;
        }
        // The field is rounded as they are, and rounding keeps order.
        Reach {
            low: changed(self.modifier, low),
            high: changed(self.modifier, high),
        }
    }
}

/// Maps points to where a placed branch is asked.
struct Inside<'a> {
    map: &'a Similarity,
    points: &'a Vec3<F64x32>,
}

impl Task for Inside<'_> {
    type Output = Vec3<F64x32>;

    #[inline(always)]
    fn run(self) -> Vec3<F64x32> {
        self.map.inside(self.points)
    }
}

/// Finds the values of a placed branch, given those in its own units.
struct Outside<'a> {
    map: &'a Similarity,
    value: &'a F64x32,
}

impl Task for Outside<'_> {
    type Output = F64x32;

    #[inline(always)]
    fn run(self) -> F64x32 {
        self.map.field(*self.value)
    }
}

/// Joins a further child of a combination to those before it.
struct Joining<'a> {
    combination: &'a Combination,
    all: &'a mut F64x32,
    own: &'a F64x32,
}

impl Task for Joining<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        *self.all = join(self.combination, *self.all, *self.own);
    }
}

/// Finds the values of a leaf in balls of these radii, given those at their centres.
struct Around<'a> {
    value: &'a F64x32,
    radii: &'a F64x32,
    lipschitz: f64,
    noise: f64,
}

impl Task for Around<'_> {
    type Output = Reach;

    #[inline(always)]
    fn run(self) -> Reach {
        let room = *self.radii * F64x32::splat(self.lipschitz * (1.0 + 1e-9));
        let room = room + F64x32::splat(self.noise);
        Reach {
            low: *self.value - room,
            high: *self.value + room,
        }
    }
}

#[inline(always)]
fn join<N: Number>(combination: &Combination, a: N, b: N) -> N {
    with_compiled_blend!(&combination.blend, blend => combination.operation.join(blend, a, b))
        .expect("a thicket has compiled blends alone")
}

/// What is left of a branch; none where no leaf has a say.
fn left(branch: &Branch, has_say: &dyn Fn(usize) -> bool) -> Option<Branch> {
    match branch {
        Branch::Leaf(number) => has_say(*number).then(|| branch.clone()),
        Branch::Join(combination, children) => {
            let mut kept: Vec<Branch> = children.iter().filter_map(|c| left(c, has_say)).collect();
            match kept.len() {
                0 | 1 => kept.pop(),
                _ => Some(Branch::Join(combination.clone(), kept)),
            }
        }
        Branch::Placed(map, child) => {
            left(child, has_say).map(|child| Branch::Placed(*map, Box::new(child)))
        }
        Branch::Changed(modifier, child) => {
            left(child, has_say).map(|child| Branch::Changed(modifier.clone(), Box::new(child)))
        }
    }
}

/// Finds in which balls a further child of a combination has no say beside what came before it, or the other way round. As
/// a union: whose smallest value is above the other's largest by the width of the blend has none.
struct Standing<'a> {
    combination: &'a Combination,
    /// The reach of the child.
    own: Reach,
    /// The reach of those before it; then of all.
    all: &'a mut Reach,
}

/// The balls in which a child has no say, and those in which all before it have none.
struct Silenced {
    own: u32,
    others: u32,
}

impl Task for Standing<'_> {
    type Output = Silenced;

    #[inline(always)]
    fn run(self) -> Silenced {
        let operation = self.combination.operation;
        let width = self.combination.blend.width().unwrap_or(f64::INFINITY);
        let (all, own) = match operation {
            Operation::Union | Operation::Joint => (*self.all, self.own),
            Operation::Intersection => (self.all.negated(), self.own.negated()),
            Operation::Difference => (self.all.negated(), self.own),
        };
        // What is subtracted from always has a say.
        let alone = if operation == Operation::Difference {
            f64::INFINITY
        } else {
            width
        };
        let joined = joined_reach(self.combination, *self.all, self.own);
        let mut silenced = Silenced { own: 0, others: 0 };
        for i in 0..F64x32::WIDTH {
            let is_silent = own.low.0[i] > all.high.0[i] + width;
            let is_alone = own.high.0[i] + alone < all.low.0[i];
            silenced.own |= u32::from(is_silent) << i;
            silenced.others |= u32::from(is_alone && !is_silent) << i;
            let pick = |all: f64, own: f64, joined: f64| {
                let other = if is_alone { own } else { joined };
                if is_silent { all } else { other }
            };
            let (low, high) = (self.all.low.0[i], self.all.high.0[i]);
            self.all.low.0[i] = pick(low, self.own.low.0[i], joined.low.0[i]);
            self.all.high.0[i] = pick(high, self.own.high.0[i], joined.high.0[i]);
        }
        silenced
    }
}

/// The reach of a combination of two fields: it rises with both, or falls with what is subtracted.
#[inline(always)]
fn joined_reach(combination: &Combination, a: Reach, b: Reach) -> Reach {
    let b = match combination.operation {
        Operation::Difference => Reach {
            low: b.high,
            high: b.low,
        },
        _ => b,
    };
    // Room for the rounding of the join itself.
    let room = |x: F64x32| x.abs() * F64x32::splat(8.0 * f64::EPSILON);
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
    use crate::catalogue::{AnyBlend, AnyPrimitive, Circular, Cubic, Smooth, Sphere};
    use crate::catalogue::{Offset, Rotate, Scale, Shell, Translate};
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
        let blend = match nodes.len() {
            6 => AnyBlend::Smooth(Smooth::new(width)),
            5 => AnyBlend::Cubic(Cubic::new(width)),
            _ => AnyBlend::Circular(Circular::new(width)),
        };
        let blend = blend.simplified();
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
            let balls = (0..4 + seed % 3).map(|i| ball(seed * 100 + k * 10 + i));
            let balls = balls.collect();
            placed(
                seed + k,
                combined(operations[(seed + k) as usize % 3], width, balls),
            )
        };
        let first = operations[seed as usize % 3];
        placed(seed / 4, combined(first, 0.2, (0..4).map(branch).collect()))
    }

    /// A node moved, turned, scaled, grown, made hollow, or all of it.
    fn placed(seed: u64, node: Arc<Node>) -> Arc<Node> {
        let steps: &[AnyModifier] = &[
            AnyModifier::Translate(Translate::new(place(seed, 0.2))),
            AnyModifier::Rotate(Rotate::new(random(seed), [0.6, 0.0, 0.8], 0.0, 0.0, 0.0)),
            AnyModifier::Scale(Scale::new([0.8 + 0.5 * random(seed); 3])),
            AnyModifier::Offset(Offset::new(0.1 * random(seed))),
            AnyModifier::Shell(Shell::new(0.1 + 0.1 * random(seed))),
        ];
        let wanted = match seed % 7 {
            6 => steps,
            k => &steps[k as usize..(k as usize + 1).min(5)],
        };
        let place = |node, step: &AnyModifier| Node::modifier(step.clone(), node).unwrap();
        wanted.iter().fold(node, place)
    }

    #[test]
    fn what_is_left_has_the_bits_of_the_whole() {
        let (mut left, mut all) = (0, 0);
        for seed in 0..60 {
            let node = tree(seed);
            let thicket = Thicket::new(&node, Level::best(), Bounds::EVERYWHERE, &|leaf, _| {
                leaf.lipschitz()
            })
            .unwrap();
            let whole = compile_wide::<F64x32>(&node, Level::best());
            let centres: Vec<[f64; 3]> = (0..32).map(|k| place(seed * 64 + k, 2.5)).collect();
            let axis = |axis: usize| Lanes::from_fn(|lane| centres[lane][axis]);
            let points = Vec3::new(axis(0), axis(1), axis(2));
            let values = thicket.values(&points);
            assert_eq!(thicket.joined(&values), whole(&points));
            let radii = Lanes::from_fn(|lane| 0.6 * random(seed + lane as u64));
            let sifted = thicket.sifted(&values, &radii, 1e-12);
            for (lane, centre) in centres.iter().enumerate() {
                let radius = radii.0[lane];
                let thinned = thicket.thinned(&sifted, lane);
                (left, all) = (left + thinned.leaves(), all + thicket.leaves());
                let inside = |k: usize, axis: usize| {
                    let way = place(seed * 1000 + k as u64, 1.0);
                    let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
                    centre[axis] + way[axis] / length * radius * random(k as u64)
                };
                let axis = |axis: usize| Lanes::from_fn(|k| inside(k, axis));
                let places = Vec3::new(axis(0), axis(1), axis(2));
                let (expected, found) = (whole(&places), thicket.value(&thinned)(&places));
                assert_eq!(expected, found, "seed {seed}");
                let (low, high) = (sifted.reach.low.0[lane], sifted.reach.high.0[lane]);
                assert!(expected.0.iter().all(|x| low <= *x && *x <= high));
                let some = |x: F64x32, axis| Dual::variable(Lanes::from_fn(|k| x.0[k]), axis);
                let moving = Vec3::new(some(places.x, 0), some(places.y, 1), some(places.z, 2));
                let gradient = thicket.gradient(&thinned).expect("no graphs")(&moving);
                let expected = compile_convex(&node, Level::best())(&moving);
                assert_eq!(gradient.partial, expected.partial, "seed {seed}");
            }
        }
        assert!(3 * left < 2 * all, "{left} of {all} leaves are left");
    }

    /// In a ball, values reach as far as the constants of the leaves allow.
    #[test]
    fn wrong_constants_are_those_of_the_leaves_too() {
        let width = |factor: f64| {
            let node = tree(1);
            let thicket =
                Thicket::new(&node, Level::best(), Bounds::EVERYWHERE, &|_, _| 1.0).unwrap();
            let thicket = thicket.with_constants_times(factor);
            let all = |x: f64| Lanes([x; 32]);
            let values = thicket.values(&Vec3::new(all(100.0), all(0.0), all(0.0)));
            let reach = thicket.sifted(&values, &all(0.1), 0.0).reach;
            reach.high.0[0] - reach.low.0[0]
        };
        assert!((width(1.0) - 0.2).abs() < 1e-6, "{}", width(1.0));
        assert!((width(4.0) / width(1.0) - 4.0).abs() < 1e-6);
    }
}
