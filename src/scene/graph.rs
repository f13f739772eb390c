//! Graphs: what a user's field or pattern computes, as data.
//!
//! The language runs the body once with a symbolic point; every operation on it becomes an entry here. Equal entries
//! are shared, constants are folded, and an `if` on the point becomes a select. Evaluation is a walk over a list.

use super::Node;
use super::extent::extent;
use super::period::period;
use super::registers::Registers;
use crate::catalogue::{Bounds, Function};
use crate::num::{Interval, Number, Steep, Vec3};
use std::collections::HashMap;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

/// A value inside a [`GraphBuilder`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Id(u32);

impl Id {
    /// That of the operation at this place in the list.
    pub(super) fn at(place: usize) -> Self {
        Self(place as u32)
    }

    /// The place of its operation in the list.
    pub(super) fn index(self) -> usize {
        self.0 as usize
    }
}

/// Where in a script an operation was written, in the language's own terms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mark(pub u64);

/// One operation; operands come before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Op {
    /// A constant, by its bits.
    Constant(u64),
    /// Component x, y or z of the point.
    Coordinate(u8),
    Negate(Id),
    Add(Id, Id),
    Subtract(Id, Id),
    Multiply(Id, Id),
    Divide(Id, Id),
    Square(Id),
    /// A function of up to three operands; unused ones repeat the first.
    Call(Function, [Id; 3]),
    /// The third where the first is below the second, else the fourth.
    Select([Id; 4]),
    /// The field of a shape, by number, at a point.
    Shape(u32, [Id; 3]),
}

impl Op {
    /// Its operands, and how many of them count.
    pub(super) fn operands(&self) -> ([Id; 4], usize) {
        let pad = |ids: &[Id]| {
            let first = ids.first().copied().unwrap_or(Id(0));
            (
                std::array::from_fn(|i| ids.get(i).copied().unwrap_or(first)),
                ids.len(),
            )
        };
        match self {
            Self::Constant(_) | Self::Coordinate(_) => pad(&[]),
            Self::Negate(a) | Self::Square(a) => pad(&[*a]),
            Self::Add(a, b) | Self::Subtract(a, b) | Self::Multiply(a, b) | Self::Divide(a, b) => {
                pad(&[*a, *b])
            }
            Self::Call(_, ids) | Self::Shape(_, ids) => pad(ids),
            Self::Select(ids) => pad(ids),
        }
    }

    /// The same operation on other operands.
    pub(super) fn with_operands(self, rename: impl Fn(Id) -> Id) -> Self {
        match self {
            Self::Constant(_) | Self::Coordinate(_) => self,
            Self::Negate(a) => Self::Negate(rename(a)),
            Self::Square(a) => Self::Square(rename(a)),
            Self::Add(a, b) => Self::Add(rename(a), rename(b)),
            Self::Subtract(a, b) => Self::Subtract(rename(a), rename(b)),
            Self::Multiply(a, b) => Self::Multiply(rename(a), rename(b)),
            Self::Divide(a, b) => Self::Divide(rename(a), rename(b)),
            Self::Call(f, ids) => Self::Call(f, ids.map(rename)),
            Self::Shape(i, ids) => Self::Shape(i, ids.map(rename)),
            Self::Select(ids) => Self::Select(ids.map(rename)),
        }
    }
}

/// Collects the operations of one body.
#[derive(Debug, Default)]
pub struct GraphBuilder {
    ops: Vec<Op>,
    /// Where each operation was first written.
    marks: Vec<Mark>,
    mark: Mark,
    known: HashMap<Op, Id>,
    shapes: Vec<Arc<Node>>,
    /// Whether a product with the constant 0 is 0, whatever the other factor: as derivatives want it.
    drops_zeros: bool,
}

impl GraphBuilder {
    /// A builder for derivatives: a product with the constant 0 is 0, even times what may be infinite.
    pub(super) fn for_derivatives() -> Self {
        Self {
            drops_zeros: true,
            ..Self::default()
        }
    }

    /// An empty builder.
    pub fn new() -> Self {
        Self::default()
    }

    /// How many different operations there are so far.
    pub fn len(&self) -> usize {
        self.ops.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.ops.is_empty()
    }

    /// Says where in the script the operations to come are written, and gives what was said before.
    pub fn mark(&mut self, mark: Mark) -> Mark {
        std::mem::replace(&mut self.mark, mark)
    }

    /// A constant.
    pub fn constant(&mut self, x: f64) -> Id {
        self.push(Op::Constant(x.to_bits()))
    }

    /// The three components of the symbolic point.
    pub fn point(&mut self) -> [Id; 3] {
        [0, 1, 2].map(|axis| self.push(Op::Coordinate(axis)))
    }

    /// The value of `id`, if it is a constant.
    pub fn known(&self, id: Id) -> Option<f64> {
        match self.ops[id.0 as usize] {
            Op::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// -a
    pub fn negate(&mut self, a: Id) -> Id {
        self.push(Op::Negate(a))
    }

    /// a + b
    pub fn add(&mut self, a: Id, b: Id) -> Id {
        match (self.known(a), self.known(b)) {
            (Some(0.0), _) => b,
            (_, Some(0.0)) => a,
            _ => self.push(Op::Add(a, b)),
        }
    }

    /// a - b
    pub fn subtract(&mut self, a: Id, b: Id) -> Id {
        if self.known(b) == Some(0.0) {
            return a;
        }
        self.push(Op::Subtract(a, b))
    }

    /// a * b
    pub fn multiply(&mut self, a: Id, b: Id) -> Id {
        match (self.known(a), self.known(b)) {
            (Some(1.0), _) => b,
            (_, Some(1.0)) => a,
            (Some(0.0), _) if self.drops_zeros => a,
            (_, Some(0.0)) if self.drops_zeros => b,
            _ if a == b => self.push(Op::Square(a)),
            _ => self.push(Op::Multiply(a, b)),
        }
    }

    /// a / b
    pub fn divide(&mut self, a: Id, b: Id) -> Id {
        let is_zero = self.drops_zeros && self.known(a) == Some(0.0);
        if is_zero || self.known(b) == Some(1.0) {
            return a;
        }
        if let Some(inverse) = self.known(b).and_then(exact_inverse) {
            let inverse = self.constant(inverse);
            return self.multiply(a, inverse);
        }
        self.push(Op::Divide(a, b))
    }

    /// The function at as many arguments as it names.
    ///
    /// # Panics
    /// If there are none, or more than three.
    pub fn call(&mut self, function: Function, arguments: &[Id]) -> Id {
        if function == Function::Sqrt
            && let Some(length) = self.root_of_squares(arguments[0])
        {
            return length;
        }
        let ids = std::array::from_fn(|i| arguments.get(i).copied().unwrap_or(arguments[0]));
        self.push(Op::Call(function, ids))
    }

    /// The root of a square or of a sum of two or three squares, as the length that it is: the same bits, with a slope
    /// that is known at 0 too.
    fn root_of_squares(&mut self, radicand: Id) -> Option<Id> {
        let side = |id: Id| match self.ops[id.index()] {
            Op::Square(side) => Some(side),
            _ => None,
        };
        if let Some(a) = side(radicand) {
            return Some(self.call(Function::Abs, &[a]));
        }
        let Op::Add(left, c) = self.ops[radicand.index()] else {
            return None;
        };
        let c = side(c)?;
        if let Some(a) = side(left) {
            return Some(self.call(Function::Hypot, &[a, c]));
        }
        let Op::Add(a, b) = self.ops[left.index()] else {
            return None;
        };
        let (a, b) = (side(a)?, side(b)?);
        Some(self.call(Function::Norm3, &[a, b, c]))
    }

    /// `x` where `a < b`, else `y`.
    pub fn select_lt(&mut self, a: Id, b: Id, x: Id, y: Id) -> Id {
        if x == y {
            return x;
        }
        self.push(Op::Select([a, b, x, y]))
    }

    /// The field of `shape` at the point with these components.
    pub fn shape(&mut self, shape: &Arc<Node>, p: [Id; 3]) -> Id {
        let known = self.shapes.iter().position(|s| Arc::ptr_eq(s, shape));
        let index = known.unwrap_or_else(|| {
            self.shapes.push(shape.clone());
            self.shapes.len() - 1
        });
        self.push(Op::Shape(index as u32, p))
    }

    /// The graph of `outputs`, without what they do not need.
    pub fn finish(&self, outputs: &[Id]) -> Graph {
        let parts = match outputs {
            [output] if self.ops.len() <= MAX_SPLIT => self.parts(*output),
            _ => Parts::Whole,
        };
        Graph {
            parts,
            ..self.whole(outputs)
        }
    }

    /// What the outermost operation joins.
    fn parts(&self, output: Id) -> Parts {
        let graphs = |ids: Vec<Id>| ids.iter().map(|id| self.whole(&[*id])).collect();
        match self.ops[output.index()] {
            Op::Call(Function::Min, _) => {
                let mut operands = Vec::new();
                self.least(output, &mut operands);
                Parts::Least(graphs(operands))
            }
            Op::Add(..) | Op::Subtract(..) => {
                let mut terms = Vec::new();
                self.terms(output, &mut terms);
                Parts::Sum(graphs(terms))
            }
            _ => Parts::Whole,
        }
    }

    /// The operands of a minimum of minima.
    fn least(&self, id: Id, operands: &mut Vec<Id>) {
        match self.ops[id.index()] {
            Op::Call(Function::Min, [a, b, _]) if operands.len() < MAX_PARTS => {
                self.least(a, operands);
                self.least(b, operands);
            }
            _ => operands.push(id),
        }
    }

    /// The terms of a sum of sums, whatever their signs.
    fn terms(&self, id: Id, terms: &mut Vec<Id>) {
        match self.ops[id.index()] {
            Op::Add(a, b) | Op::Subtract(a, b) if terms.len() < MAX_PARTS => {
                self.terms(a, terms);
                self.terms(b, terms);
            }
            _ => terms.push(id),
        }
    }

    /// The graph of `outputs` without its parts.
    fn whole(&self, outputs: &[Id]) -> Graph {
        let mut is_needed = vec![false; self.ops.len()];
        for id in outputs {
            is_needed[id.0 as usize] = true;
        }
        for i in (0..self.ops.len()).rev() {
            if is_needed[i] {
                let (ids, n) = self.ops[i].operands();
                ids[..n]
                    .iter()
                    .for_each(|id| is_needed[id.0 as usize] = true);
            }
        }
        let mut place = vec![Id(0); self.ops.len()];
        let (mut ops, mut marks) = (Vec::new(), Vec::new());
        let mut shapes: Vec<Arc<Node>> = Vec::new();
        let mut shape_place = vec![None; self.shapes.len()];
        for (i, op) in self.ops.iter().enumerate().filter(|(i, _)| is_needed[*i]) {
            place[i] = Id(ops.len() as u32);
            let mut op = op.with_operands(|id| place[id.0 as usize]);
            if let Op::Shape(shape, _) = &mut op {
                let index = *shape as usize;
                *shape = *shape_place[index].get_or_insert_with(|| {
                    shapes.push(self.shapes[index].clone());
                    shapes.len() as u32 - 1
                });
            }
            ops.push(op);
            marks.push(self.marks[i]);
        }
        let outputs: Vec<Id> = outputs.iter().map(|id| place[id.0 as usize]).collect();
        let periods = [0, 1, 2].map(|axis| period(&ops, &outputs, axis));
        let (steps, registers, outputs) = allocate(&ops, &outputs);
        Graph {
            steps,
            marks,
            registers,
            outputs,
            shapes,
            periods,
            parts: Parts::Whole,
            derived: Arc::default(),
        }
    }

    /// The id of `op`: a constant where all operands are, an equal one that is there already, or a new one.
    fn push(&mut self, op: Op) -> Id {
        let op = self.folded(op).unwrap_or(op);
        if let Some(id) = self.known.get(&op) {
            return *id;
        }
        let id = Id(self.ops.len() as u32);
        self.ops.push(op);
        self.marks.push(self.mark);
        self.known.insert(op, id);
        id
    }

    fn folded(&self, op: Op) -> Option<Op> {
        if matches!(op, Op::Constant(_) | Op::Coordinate(_) | Op::Shape(..)) {
            return None;
        }
        let (ids, n) = op.operands();
        let mut registers = [0.0; 4];
        for (register, id) in registers.iter_mut().zip(&ids[..n]) {
            *register = self.known(*id)?;
        }
        let mut next = 0;
        let numbered = std::cell::RefCell::new(&mut next);
        let local = op.with_operands(|_| {
            let mut next = numbered.borrow_mut();
            **next += 1;
            Id(**next - 1)
        });
        let nowhere = Vec3::splat([0.0; 3]);
        let value = apply(&local, &nowhere, &registers, &|_, _: &Vec3<f64>| f64::NAN);
        Some(Op::Constant(value.to_bits()))
    }
}

/// The reciprocal of a power of two, by which a product has the bits of the quotient.
fn exact_inverse(divisor: f64) -> Option<f64> {
    let is_power = divisor.to_bits() & ((1 << 52) - 1) == 0;
    let is_moderate = (2f64.powi(-100)..2f64.powi(100)).contains(&divisor.abs());
    (is_power && is_moderate).then_some(1.0 / divisor)
}

/// A step of the finished list: an operation on registers, and the register that takes its value.
#[derive(Clone, Copy, Debug)]
struct Step {
    op: Op,
    into: u32,
}

/// Gives every operation a register: steps, the number of registers, the outputs.
fn allocate(ops: &[Op], outputs: &[Id]) -> (Vec<Step>, usize, Vec<u32>) {
    let reads = |op: &Op| {
        let (ids, n) = op.operands();
        ids[..n].to_vec()
    };
    let mut registers = Registers::new(ops.len(), ops.iter().map(reads), outputs, 0);
    let mut steps = Vec::with_capacity(ops.len());
    for (i, op) in ops.iter().enumerate() {
        let renamed = op.with_operands(|id| registers.of(id));
        registers.end(i, &reads(op));
        let into = registers.take(Id::at(i)).0;
        steps.push(Step { op: renamed, into });
    }
    let outputs = outputs.iter().map(|id| registers.of(*id).0);
    let outputs = outputs.collect();
    (steps, registers.count(), outputs)
}

/// The value of one operation on registers.
#[inline(always)]
pub(super) fn apply<N: Number>(
    op: &Op,
    p: &Vec3<N>,
    registers: &[N],
    shape: &impl Fn(usize, &Vec3<N>) -> N,
) -> N {
    let r = |id: Id| registers[id.0 as usize];
    match *op {
        Op::Constant(bits) => N::splat(f64::from_bits(bits)),
        Op::Coordinate(axis) => p.component(axis as usize),
        Op::Negate(a) => -r(a),
        Op::Add(a, b) => r(a) + r(b),
        Op::Subtract(a, b) => r(a) - r(b),
        Op::Multiply(a, b) => r(a) * r(b),
        Op::Divide(a, b) => r(a) / r(b),
        Op::Square(a) => r(a).square(),
        Op::Call(function, [a, b, c]) => function.apply(&[r(a), r(b), r(c)]),
        Op::Select([a, b, x, y]) => N::select_lt(r(a), r(b), r(x), r(y)),
        Op::Shape(index, [x, y, z]) => shape(index as usize, &Vec3::new(r(x), r(y), r(z))),
    }
}

/// What keeps a graph from having a finite Lipschitz constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Obstacle {
    /// A choice whose two values differ by this much where it changes.
    Choice(f64),
    /// A function that jumps or is infinitely steep there.
    Function(Function),
    /// A divisor that is zero there.
    Quotient,
    /// The field of a shape.
    Shape,
}

/// Lipschitz constants of a graph that were derived already.
#[derive(Debug, Default)]
struct Derived {
    /// The constants by region.
    known: Vec<(Bounds, f64)>,
    /// The boxes that hold the sublevel sets, by level.
    extents: Vec<(f64, Bounds)>,
    /// How many operations they took.
    effort: u64,
}

/// A finished list of operations on a point, with one output for a number and three for a colour.
#[derive(Clone, Debug)]
pub struct Graph {
    steps: Vec<Step>,
    marks: Vec<Mark>,
    registers: usize,
    outputs: Vec<u32>,
    shapes: Vec<Arc<Node>>,
    periods: [Option<f64>; 3],
    parts: Parts,
    derived: Arc<Mutex<Derived>>,
}

/// What the outermost operation of a graph joins, each part as a graph of its own.
#[derive(Clone, Debug)]
pub enum Parts {
    /// Nothing that is known better in parts.
    Whole,
    /// The graph is the smallest of these.
    Least(Vec<Graph>),
    /// The graph is the sum of these, each with one sign or the other.
    Sum(Vec<Graph>),
}

/// How many parts a graph is split into.
const MAX_PARTS: usize = 64;

/// Graphs with more operations than this are not split.
const MAX_SPLIT: usize = 2048;

impl Graph {
    /// How many registers [`Graph::run`] needs.
    pub fn registers(&self) -> usize {
        self.registers
    }

    /// What the outermost operation joins.
    pub fn parts(&self) -> &Parts {
        &self.parts
    }

    /// The shapes whose fields the graph uses, by number.
    pub fn shapes(&self) -> &[Arc<Node>] {
        &self.shapes
    }

    /// What `derive` gives for a region or one that is larger by at most twice `slack`: found once, with the number of
    /// boxes that it took, and then remembered with all clones of the graph.
    pub(super) fn remembered(
        &self,
        region: Bounds,
        slack: f64,
        derive: impl FnOnce(Bounds) -> (f64, usize),
    ) -> f64 {
        let mut derived = self.derived.lock().unwrap_or_else(PoisonError::into_inner);
        let outside = region.inflate(2.0 * slack);
        let is_near = |known: &Bounds| known.encloses(&region) && outside.encloses(known);
        if let Some((_, lipschitz)) = derived.known.iter().find(|(r, _)| is_near(r)) {
            return *lipschitz;
        }
        let region = region.inflate(slack);
        let (lipschitz, boxes) = derive(region);
        derived.known.push((region, lipschitz));
        derived.effort += boxes as u64 * self.work();
        lipschitz
    }

    /// A box that holds every point where the first output is at most `level`: found once, as constants are.
    pub(super) fn extent(&self, level: f64) -> Bounds {
        let mut derived = self.derived.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, bounds)) = derived.extents.iter().find(|(known, _)| *known == level) {
            return *bounds;
        }
        let (bounds, looks) = extent(self, level);
        derived.extents.push((level, bounds));
        derived.effort += looks as u64 * self.work();
        bounds
    }

    /// How many operations were spent on deriving constants of this graph and its clones so far.
    pub fn effort(&self) -> u64 {
        let derived = self.derived.lock().unwrap_or_else(PoisonError::into_inner);
        let of_parts = match &self.parts {
            Parts::Sum(parts) => parts.iter().map(Self::effort).sum(),
            _ => 0,
        };
        derived.effort + of_parts
    }

    /// After what length along each axis the derivatives repeat themselves, where they do; 0 where they do not change.
    pub fn periods(&self) -> [Option<f64>; 3] {
        self.periods
    }

    /// How many operations there are.
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// The operations, each on those before it, and which of them give the outputs.
    pub(super) fn operations(&self) -> (Vec<Op>, Vec<Id>) {
        // What each register holds by then.
        let mut held = vec![Id(0); self.registers];
        let mut ops = Vec::with_capacity(self.steps.len());
        for (i, step) in self.steps.iter().enumerate() {
            ops.push(step.op.with_operands(|id| held[id.index()]));
            held[step.into as usize] = Id::at(i);
        }
        let outputs = self.outputs.iter().map(|r| held[*r as usize]);
        (ops, outputs.collect())
    }

    /// How many operations a walk takes, with the nodes of shapes as often as they are asked.
    pub(super) fn work(&self) -> u64 {
        let of_step = |step: &Step| match step.op {
            Op::Shape(index, _) => self.shapes[index as usize].size(),
            Op::Call(function, _) => function.work(),
            _ => 1,
        };
        self.steps.iter().map(of_step).sum()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// Computes all outputs at `p`, in `registers` (at least [`Graph::registers`]); `shape` gives the field of a shape
    /// by number.
    #[inline(always)]
    pub fn run<N: Number>(
        &self,
        p: &Vec3<N>,
        registers: &mut [N],
        shape: &impl Fn(usize, &Vec3<N>) -> N,
    ) {
        for s in &self.steps {
            registers[s.into as usize] = apply(&s.op, p, registers, shape);
        }
    }

    /// Output number `i` after [`Graph::run`].
    #[inline(always)]
    pub fn output<N: Number>(&self, registers: &[N], i: usize) -> N {
        registers[self.outputs[i] as usize]
    }

    /// The first output at `p`, by walking shapes directly.
    pub fn value<N: Number>(&self, p: &Vec3<N>) -> N {
        let mut registers = vec![N::splat(0.0); self.registers];
        self.run(p, &mut registers, &|i, q| self.shapes[i].evaluate(q));
        self.output(&registers, 0)
    }

    /// Writes all that its values depend on, but the shapes that it asks.
    pub(super) fn describe(&self, out: &mut dyn fmt::Write) -> fmt::Result {
        write!(out, "{:?} {:?}", self.steps, self.outputs)
    }

    /// The first operation whose slope has no bound over `region` though those of its operands have, with where it was
    /// written and by how much the value jumps there; none where all slopes have a bound.
    pub(super) fn obstacle(&self, region: Bounds) -> Option<(Obstacle, Mark)> {
        let [x, y, z] = std::array::from_fn(|i| {
            Steep::variable(Interval::new(region.low[i], region.high[i]), i)
        });
        let p = Vec3::new(x, y, z);
        let mut registers = vec![Steep::splat(0.0); self.registers];
        for (s, mark) in self.steps.iter().zip(&self.marks) {
            let (ids, n) = s.op.operands();
            let operands = ids.map(|id| registers.get(id.index()).copied());
            let is_sound = operands[..n]
                .iter()
                .flatten()
                .all(|steep| steep.slope().is_finite());
            let value = apply(&s.op, &p, &registers, &|i, q| self.shapes[i].evaluate(q));
            registers[s.into as usize] = value;
            if value.slope().is_finite() || !is_sound {
                continue;
            }
            let obstacle = match s.op {
                Op::Select(_) => {
                    let [_, _, x, y] = operands.map(|steep| steep.map_or(0.0, |s| s.value().mid()));
                    Obstacle::Choice((x - y).abs())
                }
                Op::Call(function, _) => Obstacle::Function(function),
                Op::Divide(..) => Obstacle::Quotient,
                _ => Obstacle::Shape,
            };
            return Some((obstacle, *mark));
        }
        None
    }

    /// How many outputs there are.
    pub fn outputs(&self) -> usize {
        self.outputs.len()
    }

    /// The first outputs at a point, at most three, and how many there are of these.
    pub fn values(&self, p: [f64; 3]) -> ([f64; 3], usize) {
        // Small graphs, as patterns are, need no memory of their own.
        let mut few = [0.0; 64];
        let mut many = Vec::new();
        let registers = if self.registers <= few.len() {
            &mut few[..]
        } else {
            many.resize(self.registers, 0.0);
            &mut many[..]
        };
        self.run(&Vec3::splat(p), registers, &|i, q| {
            self.shapes[i].evaluate(q)
        });
        let count = self.outputs.len().min(3);
        let mut values = [0.0; 3];
        for (i, value) in values[..count].iter_mut().enumerate() {
            *value = self.output(registers, i);
        }
        (values, count)
    }
}
