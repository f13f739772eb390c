//! Arithmetic on numbers that are known or depend on the point of a field.

use super::limits::MAX_GRAPH;
use super::machine::{Eval, Machine};
use super::report::Diagnostic;
use super::source::Span;
use super::value::{Condition, Form, Quantity, Scalar, Value};
use crate::catalogue::Function;
use crate::scene::{GraphBuilder, Id};

/// An operation on two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Arithmetic {
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    Power,
}

impl Machine<'_> {
    /// The graph of the field that is being made.
    ///
    /// # Panics
    /// If none is: then no number depends on a point.
    pub fn builder(&mut self) -> &mut GraphBuilder {
        self.builders
            .last_mut()
            .expect("only a field that is being made has symbolic numbers")
    }

    /// The number in the graph.
    pub fn id(&mut self, scalar: Scalar) -> Id {
        match scalar {
            Scalar::Known(x) => self.builder().constant(x),
            Scalar::Symbolic(id) => id,
        }
    }

    fn scalar(&mut self, id: Id) -> Scalar {
        match self.builder().known(id) {
            Some(x) => Scalar::Known(x),
            None => Scalar::Symbolic(id),
        }
    }

    /// Stops a graph that has grown too large.
    pub fn check_graph(&mut self, at: Span) -> Eval<()> {
        let is_small = self
            .builders
            .last()
            .is_none_or(|builder| builder.len() <= MAX_GRAPH);
        if is_small {
            return Ok(());
        }
        let message = format!("the field has more than {MAX_GRAPH} operations (limit MAX_GRAPH)");
        self.fail(Diagnostic::error(at, message))
    }

    /// `a` and `b` joined by `operation`.
    pub fn arithmetic(&mut self, operation: Arithmetic, a: Scalar, b: Scalar) -> Scalar {
        use Arithmetic::*;
        if let (Scalar::Known(a), Scalar::Known(b)) = (a, b) {
            return Scalar::Known(known(operation, a, b));
        }
        if operation == Power {
            return self.symbolic_power(a, b);
        }
        let (a, b) = (self.id(a), self.id(b));
        let builder = self.builder();
        let id = match operation {
            Add => builder.add(a, b),
            Subtract => builder.subtract(a, b),
            Multiply => builder.multiply(a, b),
            Divide => builder.divide(a, b),
            _ => builder.call(Function::Modulo, &[a, b]),
        };
        self.scalar(id)
    }

    /// A power in a graph: whole exponents by products, so that negative numbers have one.
    fn symbolic_power(&mut self, base: Scalar, exponent: Scalar) -> Scalar {
        const LARGEST: f64 = 64.0;
        let base = self.id(base);
        let Scalar::Known(e) = exponent else {
            let exponent = self.id(exponent);
            let id = self.builder().call(Function::Pow, &[base, exponent]);
            return self.scalar(id);
        };
        let builder = self.builder();
        let id = if e == 0.5 {
            builder.call(Function::Sqrt, &[base])
        } else if e.fract() == 0.0 && e.abs() <= LARGEST {
            let power = whole_power(builder, base, e.abs() as u32);
            if e < 0.0 {
                let one = builder.constant(1.0);
                builder.divide(one, power)
            } else {
                power
            }
        } else {
            let exponent = builder.constant(e);
            builder.call(Function::Pow, &[base, exponent])
        };
        self.scalar(id)
    }

    /// -a
    pub fn negated(&mut self, a: Scalar) -> Scalar {
        match a {
            Scalar::Known(x) => Scalar::Known(-x),
            Scalar::Symbolic(id) => {
                let id = self.builder().negate(id);
                self.scalar(id)
            }
        }
    }

    /// A function of the catalogue.
    pub fn apply(&mut self, function: Function, arguments: &[Scalar]) -> Scalar {
        let mut values = [0.0; 3];
        let mut is_known = true;
        for (value, argument) in values.iter_mut().zip(arguments) {
            match argument {
                Scalar::Known(x) => *value = *x,
                Scalar::Symbolic(_) => is_known = false,
            }
        }
        if is_known {
            return Scalar::Known(match function {
                Function::Pow => libm::pow(values[0], values[1]),
                _ => function.apply(&values[..arguments.len()]),
            });
        }
        if function == Function::Pow {
            return self.symbolic_power(arguments[0], arguments[1]);
        }
        let ids: Vec<Id> = arguments.iter().map(|scalar| self.id(*scalar)).collect();
        let id = self.builder().call(function, &ids);
        self.scalar(id)
    }

    /// The scalar product of as many components as both have.
    pub fn dot(&mut self, a: &[Scalar], b: &[Scalar]) -> Scalar {
        let mut sum = Scalar::Known(0.0);
        for (x, y) in a.iter().zip(b) {
            let product = self.arithmetic(Arithmetic::Multiply, *x, *y);
            sum = self.arithmetic(Arithmetic::Add, sum, product);
        }
        sum
    }

    /// The Euclidean length.
    pub fn length(&mut self, v: &[Scalar]) -> Scalar {
        match v {
            [x, y] => self.apply(Function::Hypot, &[*x, *y]),
            [x, y, z] => self.apply(Function::Norm3, &[*x, *y, *z]),
            _ => self.apply(Function::Abs, v),
        }
    }

    /// The condition `a < b`, or `not a < b`; known where both are.
    pub fn less(&mut self, a: Scalar, b: Scalar, is_negated: bool) -> Value {
        if let (Scalar::Known(a), Scalar::Known(b)) = (a, b) {
            return Value::Bool((a < b) != is_negated);
        }
        let (a, b) = (self.id(a), self.id(b));
        Value::Condition(Condition { a, b, is_negated })
    }

    /// The condition as a number, 1 where it holds and 0 elsewhere.
    pub fn flag(&mut self, condition: &Value) -> Scalar {
        match condition {
            Value::Bool(holds) => Scalar::Known(f64::from(*holds)),
            Value::Condition(condition) => {
                self.choose(*condition, Scalar::Known(1.0), Scalar::Known(0.0))
            }
            _ => Scalar::Known(0.0),
        }
    }

    /// The condition that a flag stands for.
    pub fn condition(&mut self, flag: Scalar) -> Value {
        self.less(Scalar::Known(0.5), flag, false)
    }

    /// `yes` where the condition holds, else `no`.
    pub fn choose(&mut self, condition: Condition, yes: Scalar, no: Scalar) -> Scalar {
        let (yes, no) = match condition.is_negated {
            true => (self.id(no), self.id(yes)),
            false => (self.id(yes), self.id(no)),
        };
        let id = self.builder().select_lt(condition.a, condition.b, yes, no);
        self.scalar(id)
    }

    /// One of two values, by a condition that depends on the point: both must be of the same kind.
    pub fn select(&mut self, condition: Condition, yes: Value, no: Value, at: Span) -> Eval<Value> {
        let is_condition = |value: &Value| matches!(value, Value::Bool(_) | Value::Condition(_));
        if is_condition(&yes) && is_condition(&no) {
            let (yes, no) = (self.flag(&yes), self.flag(&no));
            let flag = self.choose(condition, yes, no);
            return Ok(self.condition(flag));
        }
        if let (Some(a), Some(b)) = (yes.quantity(), no.quantity())
            && (a.form, a.count) == (b.form, b.count)
        {
            let mut chosen = [Scalar::Known(0.0); 3];
            for (i, scalar) in chosen[..a.count].iter_mut().enumerate() {
                *scalar = self.choose(condition, a.scalars[i], b.scalars[i]);
            }
            self.check_graph(at)?;
            return Ok(Quantity::new(a.form, &chosen[..a.count]).value());
        }
        let message = format!(
            "this condition depends on the point, so both branches must be numbers, vectors or colours alike; these \
             are {} and {}",
            yes.noun(),
            no.noun()
        );
        self.fail(Diagnostic::error(at, message))
    }

    /// The joint form of two quantities under an operation that works by components.
    pub fn joined_form(a: &Quantity, b: &Quantity) -> Option<(Form, usize)> {
        match (a.form, b.form) {
            (Form::Number, Form::Number) => Some((Form::Number, 1)),
            (form, Form::Number) if form != Form::Angle => Some((form, a.count)),
            (Form::Number, form) if form != Form::Angle => Some((form, b.count)),
            (x, y) if x == y && a.count == b.count => Some((x, a.count)),
            _ => None,
        }
    }
}

fn known(operation: Arithmetic, a: f64, b: f64) -> f64 {
    match operation {
        Arithmetic::Add => a + b,
        Arithmetic::Subtract => a - b,
        Arithmetic::Multiply => a * b,
        Arithmetic::Divide => a / b,
        Arithmetic::Remainder => Function::Modulo.apply(&[a, b]),
        Arithmetic::Power => libm::pow(a, b),
    }
}

/// `base^n` by repeated squaring.
fn whole_power(builder: &mut GraphBuilder, base: Id, n: u32) -> Id {
    let mut power = builder.constant(1.0);
    let (mut square, mut left) = (base, n);
    while left > 0 {
        if left & 1 == 1 {
            power = builder.multiply(power, square);
        }
        left >>= 1;
        if left > 0 {
            square = builder.multiply(square, square);
        }
    }
    power
}
