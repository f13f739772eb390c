//! Programs: a graph as a list of instructions, for evaluation over numbers that are costly to carry about.
//!
//! Instructions read and write registers, and a register of 32 lanes takes 256 bytes. So constants stand in the instructions,
//! a product goes into the sum that wants it, and the sine and the cosine of one angle are found together. Each operation
//! is that of the graph on the same operands, so the results have the same bits.

use super::graph::{Graph, Id, Op, apply};
use super::registers::Registers;
use crate::catalogue::Function;
use crate::num::{Number, Vec3};

/// What an instruction computes from its operands, which are values of the graph, then registers.
#[derive(Clone, Copy, Debug)]
enum Rule {
    /// An operation as it stands in the graph.
    Plain(Op),
    /// a * k
    Times(Id, f64),
    /// a + k
    Plus(Id, f64),
    /// a - k
    Minus(Id, f64),
    /// k - a
    From(f64, Id),
    /// a * b + c, rounded twice.
    TimesPlus([Id; 3]),
    /// The sine and the cosine of an angle.
    SinCos(Id),
}

impl Rule {
    fn operands(&self) -> Vec<Id> {
        match *self {
            Self::Plain(op) => {
                let (ids, n) = op.operands();
                ids[..n].to_vec()
            }
            Self::Times(a, _) | Self::Plus(a, _) | Self::Minus(a, _) | Self::From(_, a) => vec![a],
            Self::TimesPlus(ids) => ids.to_vec(),
            Self::SinCos(a) => vec![a],
        }
    }

    fn with_operands(self, rename: impl Fn(Id) -> Id) -> Self {
        match self {
            Self::Plain(op) => Self::Plain(op.with_operands(rename)),
            Self::Times(a, k) => Self::Times(rename(a), k),
            Self::Plus(a, k) => Self::Plus(rename(a), k),
            Self::Minus(a, k) => Self::Minus(rename(a), k),
            Self::From(k, a) => Self::From(k, rename(a)),
            Self::TimesPlus(ids) => Self::TimesPlus(ids.map(rename)),
            Self::SinCos(a) => Self::SinCos(rename(a)),
        }
    }
}

/// A rule, and what takes its values: a cosine the second, all else the first.
#[derive(Clone, Copy, Debug)]
struct Instruction {
    rule: Rule,
    into: [Id; 2],
}

/// A graph, ready to be walked.
#[derive(Clone, Debug)]
pub struct Program {
    instructions: Vec<Instruction>,
    registers: usize,
    outputs: Vec<Id>,
}

impl Program {
    /// The program of a graph.
    pub fn new(graph: &Graph) -> Self {
        let (ops, outputs) = graph.operations();
        let mut instructions = folded(&ops, &outputs);
        pair_waves(&mut instructions);
        drop_unused(&mut instructions, &outputs);
        allocated(&instructions, &outputs)
    }

    /// How many registers [`Program::run`] needs: at least three.
    pub fn registers(&self) -> usize {
        self.registers
    }

    /// Computes all outputs at `p`, in `registers` (at least [`Program::registers`]), of which the first three hold `p`;
    /// `shape` gives the field of a shape by number.
    #[inline(always)]
    pub fn run<N: Number>(
        &self,
        p: &Vec3<N>,
        registers: &mut [N],
        shape: &impl Fn(usize, &Vec3<N>) -> N,
    ) {
        for instruction in &self.instructions {
            let [into, beside] = instruction.into.map(Id::index);
            // Each rule writes its value itself: one that is handed to a place behind all of them lies on the stack on its way,
            // and so do operands in the list of arguments of a function.
            match instruction.rule {
                Rule::Plain(Op::Add(a, b)) => registers[into] = r(registers, a) + r(registers, b),
                Rule::Plain(Op::Subtract(a, b)) => {
                    registers[into] = r(registers, a) - r(registers, b);
                }
                Rule::Plain(Op::Multiply(a, b)) => {
                    registers[into] = r(registers, a) * r(registers, b);
                }
                Rule::Plain(Op::Square(a)) => registers[into] = r(registers, a).square(),
                Rule::Plain(Op::Call(Function::Abs, [a, ..])) => {
                    registers[into] = r(registers, a).abs();
                }
                Rule::Plain(Op::Call(Function::Sqrt, [a, ..])) => {
                    registers[into] = r(registers, a).sqrt();
                }
                Rule::Plain(Op::Call(Function::Floor, [a, ..])) => {
                    registers[into] = r(registers, a).floor();
                }
                Rule::Plain(Op::Call(Function::Min, [a, b, _])) => {
                    registers[into] = r(registers, a).min(r(registers, b));
                }
                Rule::Plain(Op::Call(Function::Max, [a, b, _])) => {
                    registers[into] = r(registers, a).max(r(registers, b));
                }
                Rule::Plain(Op::Call(Function::Sin, [a, ..])) => {
                    registers[into] = r(registers, a).sin();
                }
                Rule::Plain(Op::Call(Function::Cos, [a, ..])) => {
                    registers[into] = r(registers, a).cos();
                }
                Rule::Plain(op) => registers[into] = apply(&op, p, registers, shape),
                Rule::Times(a, k) => registers[into] = r(registers, a) * N::splat(k),
                Rule::Plus(a, k) => registers[into] = r(registers, a) + N::splat(k),
                Rule::Minus(a, k) => registers[into] = r(registers, a) - N::splat(k),
                Rule::From(k, a) => registers[into] = N::splat(k) - r(registers, a),
                Rule::TimesPlus([a, b, c]) => {
                    registers[into] = r(registers, a) * r(registers, b) + r(registers, c);
                }
                Rule::SinCos(a) => {
                    (registers[into], registers[beside]) = r(registers, a).sin_cos();
                }
            }
        }
    }

    /// Writes the outputs after [`Program::run`], as many as there is room for.
    #[inline(always)]
    pub fn write<N: Number>(&self, registers: &[N], outputs: &mut [N]) {
        for (i, output) in outputs.iter_mut().enumerate() {
            *output = self.output(registers, i);
        }
    }

    /// Output number `i` after [`Program::run`].
    #[inline(always)]
    pub fn output<N: Number>(&self, registers: &[N], i: usize) -> N {
        registers[self.outputs[i].index()]
    }
}

/// What a register holds.
#[inline(always)]
fn r<N: Number>(registers: &[N], id: Id) -> N {
    registers[id.index()]
}

/// An instruction for each operation, with constants in their places and products in sums.
fn folded(ops: &[Op], outputs: &[Id]) -> Vec<Instruction> {
    let constant = |id: Id| match ops[id.index()] {
        Op::Constant(bits) => Some(f64::from_bits(bits)),
        _ => None,
    };
    let mut uses = vec![0; ops.len()];
    let operands = ops.iter().flat_map(|op| Rule::Plain(*op).operands());
    let used = operands.chain(outputs.iter().copied());
    used.for_each(|id| uses[id.index()] += 1);
    // The factors of a product, neither of them constant, that is wanted once.
    let product = |id: Id| match ops[id.index()] {
        Op::Multiply(a, b) if uses[id.index()] == 1 => {
            (constant(a).is_none() && constant(b).is_none()).then_some([a, b])
        }
        _ => None,
    };
    let rule = |op: Op| match op {
        Op::Multiply(a, b) => match (constant(a), constant(b)) {
            (Some(k), _) => Rule::Times(b, k),
            (_, Some(k)) => Rule::Times(a, k),
            _ => Rule::Plain(op),
        },
        Op::Add(a, b) => match (constant(a), constant(b), product(a), product(b)) {
            (Some(k), ..) => Rule::Plus(b, k),
            (_, Some(k), ..) => Rule::Plus(a, k),
            (.., Some([x, y])) => Rule::TimesPlus([x, y, a]),
            (_, _, Some([x, y]), _) => Rule::TimesPlus([x, y, b]),
            _ => Rule::Plain(op),
        },
        Op::Subtract(a, b) => match (constant(a), constant(b)) {
            (Some(k), _) => Rule::From(k, b),
            (_, Some(k)) => Rule::Minus(a, k),
            _ => Rule::Plain(op),
        },
        _ => Rule::Plain(op),
    };
    let instruction = |(i, op): (usize, &Op)| Instruction {
        rule: rule(*op),
        into: [Id::at(i); 2],
    };
    ops.iter().enumerate().map(instruction).collect()
}

/// Puts the sine and the cosine of an angle, where both are there, into the place of the first of them.
fn pair_waves(instructions: &mut Vec<Instruction>) {
    let wave = |instruction: &Instruction, wanted: Function| match instruction.rule {
        Rule::Plain(Op::Call(function, [angle, ..])) => (function == wanted).then_some(angle),
        _ => None,
    };
    let mut sine = 0;
    while sine < instructions.len() {
        let angle = wave(&instructions[sine], Function::Sin);
        let is_partner = |other: &Instruction| wave(other, Function::Cos) == angle;
        if let Some(angle) = angle
            && let Some(cosine) = instructions.iter().position(is_partner)
        {
            let into = [sine, cosine].map(|i| instructions[i].into[0]);
            instructions[sine.min(cosine)] = Instruction {
                rule: Rule::SinCos(angle),
                into,
            };
            instructions.remove(sine.max(cosine));
        }
        sine += 1;
    }
}

/// Leaves out what no output needs.
fn drop_unused(instructions: &mut Vec<Instruction>, outputs: &[Id]) {
    let values = instructions.iter().flat_map(|i| i.into).max();
    let mut is_needed = vec![false; values.map_or(0, |id| id.index() + 1)];
    outputs.iter().for_each(|id| is_needed[id.index()] = true);
    let mut kept: Vec<Instruction> = Vec::new();
    for instruction in instructions.iter().rev() {
        if instruction.into.iter().any(|id| is_needed[id.index()]) {
            let operands = instruction.rule.operands();
            operands.iter().for_each(|id| is_needed[id.index()] = true);
            kept.push(*instruction);
        }
    }
    kept.reverse();
    *instructions = kept;
}

/// Gives every value a register.
fn allocated(instructions: &[Instruction], outputs: &[Id]) -> Program {
    let values = instructions.iter().flat_map(|i| i.into).max();
    let values = values.map_or(0, |id| id.index() + 1);
    let reads = instructions.iter().map(|i| i.rule.operands());
    // The point is there already.
    let mut registers = Registers::new(values, reads, outputs, 3);
    let mut renamed = Vec::with_capacity(instructions.len());
    for (i, instruction) in instructions.iter().enumerate() {
        let [first, second] = instruction.into;
        if let Rule::Plain(Op::Coordinate(axis)) = instruction.rule {
            registers.put(first, usize::from(axis));
            continue;
        }
        let rule = instruction.rule.with_operands(|id| registers.of(id));
        registers.end(i, &instruction.rule.operands());
        let into = registers.take(first);
        let beside = if second == first {
            into
        } else {
            registers.take(second)
        };
        renamed.push(Instruction {
            rule,
            into: [into, beside],
        });
    }
    Program {
        instructions: renamed,
        registers: registers.count(),
        outputs: outputs.iter().map(|id| registers.of(*id)).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::GraphBuilder;
    use super::*;
    use crate::num::samples::random;

    /// A graph in which everything occurs that a program joins, in both orders: constants on either side, products in sums, a
    /// sine before its cosine and after it, values that are wanted twice.
    fn graph() -> Graph {
        let mut g = GraphBuilder::new();
        let [x, y, z] = g.point();
        let [three, half] = [3.0, 0.5].map(|k| g.constant(k));
        let a = g.multiply(three, x);
        let b = g.multiply(y, half);
        let sine = g.call(Function::Sin, &[a]);
        let cosine = g.call(Function::Cos, &[a]);
        let other_cosine = g.call(Function::Cos, &[b]);
        let other_sine = g.call(Function::Sin, &[b]);
        let alone = g.call(Function::Sin, &[z]);
        let first = g.multiply(sine, other_cosine);
        let second = g.multiply(cosine, other_sine);
        let sum = g.add(first, second);
        let twice = g.multiply(sum, alone);
        let left = g.add(twice, z);
        let right = g.add(x, twice);
        let low = g.subtract(left, half);
        let high = g.subtract(three, right);
        let more = g.add(half, low);
        let last = g.divide(more, high);
        let square = g.multiply(last, last);
        let picked = g.select_lt(last, half, square, three);
        g.finish(&[picked, sum, three])
    }

    #[test]
    fn programs_give_the_bits_of_their_graphs() {
        let graph = graph();
        let program = Program::new(&graph);
        // The point is there already; two cosines come with their sines, a product goes into its sum.
        assert_eq!(program.instructions.len() + 3 + 2 + 1, graph.len());
        for seed in 0..1000 {
            let [x, y, z] = [0, 1, 2].map(|k| 20.0 * random(3 * seed + k) - 10.0);
            let p = Vec3::new(x, y, z);
            let mut registers = vec![f64::NAN; program.registers()];
            registers[..3].copy_from_slice(&[x, y, z]);
            program.run(&p, &mut registers, &|_, _| f64::NAN);
            let mut expected = vec![f64::NAN; graph.registers()];
            graph.run(&p, &mut expected, &|_, _| f64::NAN);
            for i in 0..3 {
                let (found, expected) = (program.output(&registers, i), graph.output(&expected, i));
                assert_eq!(found.to_bits(), expected.to_bits(), "output {i} at {p:?}");
            }
        }
    }
}
