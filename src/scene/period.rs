//! Along which axes a graph repeats itself, so that its slopes need to be looked at over one period only.

use super::graph::{Id, Op};
use crate::catalogue::Function;

/// How an operation depends on one coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    /// Not at all.
    Independent,
    /// By a constant slope.
    Affine(f64),
    /// With this frequency, in radians per scene unit.
    Periodic(f64),
    /// By a constant slope and something periodic: its derivatives are periodic.
    Drift(f64),
    /// In some other way.
    Other,
}

/// The period of the derivatives of all outputs along `axis`: none where there is none, 0 where they are the same
/// everywhere.
pub(super) fn period(ops: &[Op], outputs: &[Id], axis: u8) -> Option<f64> {
    let mut forms: Vec<Form> = Vec::with_capacity(ops.len());
    for op in ops {
        let form = form_of(op, axis, &forms, &|id| constant(ops, id));
        forms.push(form);
    }
    let mut frequency: Option<f64> = None;
    for id in outputs {
        match forms[id.index()] {
            Form::Independent | Form::Affine(_) => {}
            Form::Periodic(f) | Form::Drift(f) => frequency = Some(common(frequency, f)?),
            Form::Other => return None,
        }
    }
    Some(frequency.map_or(0.0, |f| std::f64::consts::TAU / f))
}

fn constant(ops: &[Op], id: Id) -> Option<f64> {
    match ops[id.index()] {
        Op::Constant(bits) => Some(f64::from_bits(bits)),
        _ => None,
    }
}

/// A frequency of which both are whole multiples, where one divides the other.
fn common(known: Option<f64>, f: f64) -> Option<f64> {
    let Some(known) = known else { return Some(f) };
    let (low, high) = (known.min(f), known.max(f));
    ((high / low).fract() == 0.0).then_some(low)
}

fn form_of(op: &Op, axis: u8, forms: &[Form], constant: &impl Fn(Id) -> Option<f64>) -> Form {
    let form = |id: Id| forms[id.index()];
    match *op {
        Op::Constant(_) => Form::Independent,
        Op::Coordinate(a) if a == axis => Form::Affine(1.0),
        Op::Coordinate(_) => Form::Independent,
        Op::Negate(a) => scaled(form(a), -1.0),
        Op::Add(a, b) => sum(form(a), form(b), 1.0),
        Op::Subtract(a, b) => sum(form(a), form(b), -1.0),
        Op::Multiply(a, b) => match (constant(a), constant(b)) {
            (Some(c), _) => scaled(form(b), c),
            (_, Some(c)) => scaled(form(a), c),
            _ => mixed(&[form(a), form(b)]),
        },
        Op::Divide(a, b) => match constant(b) {
            Some(c) => scaled(form(a), 1.0 / c),
            None => mixed(&[form(a), form(b)]),
        },
        Op::Call(Function::Sin | Function::Cos, [a, ..]) => match form(a) {
            Form::Affine(slope) if slope != 0.0 && slope.is_finite() => Form::Periodic(slope.abs()),
            other => mixed(&[other]),
        },
        Op::Square(a) => mixed(&[form(a)]),
        Op::Call(_, ids) => mixed(&ids.map(form)),
        Op::Select(ids) => mixed(&ids.map(form)),
        Op::Shape(_, ids) => mixed(&ids.map(form)),
    }
}

fn scaled(form: Form, c: f64) -> Form {
    match form {
        Form::Affine(slope) => Form::Affine(slope * c),
        other => other,
    }
}

fn sum(a: Form, b: Form, sign: f64) -> Form {
    match (a, b) {
        (Form::Independent, other) => scaled(other, sign),
        (other, Form::Independent) => other,
        (Form::Affine(s), Form::Affine(t)) => Form::Affine(s + sign * t),
        (Form::Affine(_), Form::Periodic(f) | Form::Drift(f))
        | (Form::Periodic(f) | Form::Drift(f), Form::Affine(_)) => Form::Drift(f),
        (Form::Periodic(f) | Form::Drift(f), Form::Periodic(g) | Form::Drift(g)) => {
            let is_periodic = matches!((a, b), (Form::Periodic(_), Form::Periodic(_)));
            match common(Some(f), g) {
                Some(f) if is_periodic => Form::Periodic(f),
                Some(f) => Form::Drift(f),
                None => Form::Other,
            }
        }
        _ => Form::Other,
    }
}

/// Any function of operands: periodic if all of them are, or do not depend on the coordinate.
fn mixed(forms: &[Form]) -> Form {
    let mut frequency = None;
    for form in forms {
        match form {
            Form::Independent => {}
            Form::Periodic(f) => match common(frequency, *f) {
                Some(f) => frequency = Some(f),
                None => return Form::Other,
            },
            _ => return Form::Other,
        }
    }
    frequency.map_or(Form::Independent, Form::Periodic)
}
