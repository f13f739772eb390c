//! Symbols: numbers that write down what is computed with them, so that an entry of the catalogue becomes a graph.

use super::{Graph, GraphBuilder, Id, Node};
use crate::catalogue::Function;
use crate::num::{Dual, Lattice, Number, Vec3};
use std::cell::RefCell;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::Arc;

thread_local! {
    /// Where this thread's symbols are written down.
    static BUILDER: RefCell<GraphBuilder> = RefCell::default();
}

/// A number that stands for an operation of the graph that is being recorded on this thread.
#[derive(Clone, Copy, Debug)]
pub(super) struct Symbol(Id);

/// What `body` computes from a point, as a graph with one output.
pub(super) fn record(body: impl FnOnce(&Vec3<Symbol>) -> Symbol) -> Graph {
    let outer = BUILDER.take();
    let [x, y, z] = BUILDER.with_borrow_mut(GraphBuilder::point).map(Symbol);
    let Symbol(output) = body(&Vec3::new(x, y, z));
    BUILDER.replace(outer).finish(&[output])
}

/// The gradient of the field of `node`, as a graph with three outputs: the field runs once with dual numbers of symbols.
pub(super) fn gradient(node: &Node) -> Graph {
    let outer = BUILDER.replace(GraphBuilder::for_derivatives());
    let [x, y, z] = BUILDER.with_borrow_mut(GraphBuilder::point).map(Symbol);
    let variable = |symbol, axis| Dual::<Symbol, 3>::variable(symbol, axis);
    let field = node.evaluate(&Vec3::new(variable(x, 0), variable(y, 1), variable(z, 2)));
    let outputs = field.partial.map(|Symbol(id)| id);
    BUILDER.replace(outer).finish(&outputs)
}

/// The field of `shape` at the point `p`.
pub(super) fn asked(shape: &Arc<Node>, p: &Vec3<Symbol>) -> Symbol {
    written(|graph| graph.shape(shape, [p.x.0, p.y.0, p.z.0]))
}

fn written(write: impl FnOnce(&mut GraphBuilder) -> Id) -> Symbol {
    Symbol(BUILDER.with_borrow_mut(write))
}

fn call(function: Function, arguments: &[Symbol]) -> Symbol {
    let first = arguments[0].0;
    let mut ids = [first; 3];
    for (id, argument) in ids.iter_mut().zip(arguments) {
        *id = argument.0;
    }
    written(|graph| graph.call(function, &ids[..arguments.len()]))
}

impl Add for Symbol {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        written(|graph| graph.add(self.0, o.0))
    }
}

impl Sub for Symbol {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        written(|graph| graph.subtract(self.0, o.0))
    }
}

impl Mul for Symbol {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        written(|graph| graph.multiply(self.0, o.0))
    }
}

impl Div for Symbol {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        written(|graph| graph.divide(self.0, o.0))
    }
}

impl Neg for Symbol {
    type Output = Self;
    fn neg(self) -> Self {
        written(|graph| graph.negate(self.0))
    }
}

impl Number for Symbol {
    type Constant = f64;

    fn constant(x: f64) -> f64 {
        x
    }

    fn spread(x: f64) -> Self {
        written(|graph| graph.constant(x))
    }
    fn min(self, other: Self) -> Self {
        call(Function::Min, &[self, other])
    }
    fn max(self, other: Self) -> Self {
        call(Function::Max, &[self, other])
    }
    fn abs(self) -> Self {
        call(Function::Abs, &[self])
    }
    fn sqrt(self) -> Self {
        call(Function::Sqrt, &[self])
    }
    fn floor(self) -> Self {
        call(Function::Floor, &[self])
    }
    fn sin(self) -> Self {
        call(Function::Sin, &[self])
    }
    fn cos(self) -> Self {
        call(Function::Cos, &[self])
    }
    fn atan2(self, x: Self) -> Self {
        call(Function::Atan2, &[self, x])
    }
    fn exp(self) -> Self {
        call(Function::Exp, &[self])
    }
    fn ln(self) -> Self {
        call(Function::Ln, &[self])
    }
    fn select_lt(a: Self, b: Self, x: Self, y: Self) -> Self {
        written(|graph| graph.select_lt(a.0, b.0, x.0, y.0))
    }
    fn clamp(self, low: Self, high: Self) -> Self {
        call(Function::Clamp, &[self, low, high])
    }
    fn mix(self, a: Self, b: Self) -> Self {
        call(Function::Mix, &[a, b, self])
    }
    fn square(self) -> Self {
        self * self
    }
    fn hypot(self, other: Self) -> Self {
        call(Function::Hypot, &[self, other])
    }
    fn norm3(x: Self, y: Self, z: Self) -> Self {
        call(Function::Norm3, &[x, y, z])
    }
    fn pow(self, e: Self) -> Self {
        call(Function::Pow, &[self, e])
    }
    fn tan(self) -> Self {
        call(Function::Tan, &[self])
    }
    fn asin(self) -> Self {
        call(Function::Asin, &[self])
    }
    fn acos(self) -> Self {
        call(Function::Acos, &[self])
    }
    fn lattice(lattice: Lattice, x: Self, y: Self, z: Self) -> Self {
        let function = match lattice {
            Lattice::Noise => Function::Noise3,
            Lattice::Voronoi => Function::Voronoi3,
        };
        call(function, &[x, y, z])
    }
    fn fract(self) -> Self {
        call(Function::Fract, &[self])
    }
}
