//! Calls of the catalogue's entries: arguments are checked against the declaration, and worded by it.

use super::arguments::{Given, bind};
use super::machine::{Eval, Machine};
use super::report::Diagnostic;
use super::source::Span;
use super::value::Value;
use crate::catalogue::{
    AXES, AnyBlend, AnyModifier, AnyPrimitive, Argument, Declaration, Kind, Manner, Operation,
    Parameter,
};
use crate::scene::{Fault, Node};
use std::sync::Arc;

/// The arguments of an entry, with the places of those that were given.
struct Filled {
    arguments: Vec<Argument>,
    places: Vec<Option<Span>>,
}

impl<'a> Machine<'a> {
    /// A leaf of the catalogue.
    pub fn primitive(
        &mut self,
        entry: &'static Declaration,
        at: Span,
        given: Vec<Given<'a>>,
    ) -> Eval<Value> {
        let filled = self.filled(entry, at, given, false)?;
        let primitive = AnyPrimitive::from_arguments(entry.name, &filled.arguments)
            .expect("the entry is in the catalogue");
        match Node::primitive(primitive) {
            Ok(node) => self.made(node, at),
            Err(fault) => self.faulty(fault, entry, at, &filled),
        }
    }

    /// A shape, or each shape of a list, changed by an entry of the catalogue.
    pub fn modifier(
        &mut self,
        entry: &'static Declaration,
        at: Span,
        mut given: Vec<Given<'a>>,
    ) -> Eval<Value> {
        let is_receiver = |given: &Given| given.label.is_none_or(|label| &*label.text == "shape");
        if !given.first().is_some_and(is_receiver) {
            let message = format!("`{}` needs a shape", entry.name);
            let help = format!("as in `sphere(1).{}(...)`", entry.name);
            return self.fail(Diagnostic::error(at, message).help(help));
        }
        let receiver = given.remove(0);
        if let Value::List(list) = &receiver.value {
            let mut changed = Vec::with_capacity(list.items.len());
            for item in &list.items {
                let mut all = vec![Given {
                    value: item.clone(),
                    ..receiver.clone()
                }];
                all.extend(given.iter().cloned());
                changed.push(self.modifier(entry, at, all)?);
            }
            return self.listed(changed, at);
        }
        let child = self.shape(&receiver.value, receiver.span)?;
        let filled = self.filled(entry, at, given, child.traits().is_planar)?;
        let modifier = AnyModifier::from_arguments(entry.name, &filled.arguments)
            .expect("the entry is in the catalogue");
        match Node::modifier(modifier, child) {
            Ok(node) => self.made(node, at),
            Err(fault) => self.faulty(fault, entry, at, &filled),
        }
    }

    /// A blend of the catalogue; with shapes before its arguments, the operation that it is.
    pub fn blend(
        &mut self,
        entry: &'static Declaration,
        at: Span,
        mut given: Vec<Given<'a>>,
    ) -> Eval<Value> {
        let is_shape = |given: &&Given| given.label.is_none() && given.value.is_shape();
        let count = given.iter().take_while(is_shape).count();
        let rest = given.split_off(count);
        let filled = self.filled(entry, at, rest, false)?;
        let blend = AnyBlend::from_arguments(entry.name, &filled.arguments)
            .expect("the entry is in the catalogue");
        if count == 0 && blend.manner() == Manner::Seam {
            return Ok(Value::Blend(Arc::new(blend)));
        }
        let mut all = Vec::new();
        for shape in given {
            self.gather(&shape.value, shape.span, &mut all)?;
        }
        self.combined(Operation::Joint, blend, all, at)
    }

    /// Counts the new shape and gives it as a value.
    pub fn made(&mut self, node: Arc<Node>, at: Span) -> Eval<Value> {
        self.count_shape(&node, at)?;
        Ok(Value::Shape(node))
    }

    fn faulty<T>(
        &mut self,
        fault: Fault,
        entry: &Declaration,
        at: Span,
        filled: &Filled,
    ) -> Eval<T> {
        let Some(name) = fault.parameter else {
            return self.fault(fault, at);
        };
        let place = entry.parameters.iter().position(|p| p.name == name);
        let span = place.and_then(|i| filled.places[i]).unwrap_or(at);
        let message = format!("`{name}` of `{}` {}", entry.name, fault.message);
        let mut error = Diagnostic::error(span, message);
        if let Some(value) = place.map(|i| &filled.arguments[i])
            && span != at
        {
            error = error.label(format!("this is {value}"));
        }
        if !fault.hint.is_empty() {
            error = error.help(fault.hint);
        }
        self.fail(error)
    }

    /// Reports why a node can't exist.
    pub fn fault<T>(&mut self, fault: Fault, at: Span) -> Eval<T> {
        let error = Diagnostic::error(at, fault.message);
        self.fail(match fault.hint.as_str() {
            "" => error,
            hint => error.help(hint),
        })
    }

    /// One argument for each parameter of the entry, given or by default.
    fn filled(
        &mut self,
        entry: &Declaration,
        at: Span,
        given: Vec<Given<'a>>,
        is_planar: bool,
    ) -> Eval<Filled> {
        let slots: Vec<_> = entry
            .parameters
            .iter()
            .map(|p| (p.name, p.default.is_none()))
            .collect();
        let bound = match bind(entry.name, &slots, at, given) {
            Ok(bound) => bound,
            Err(diagnostic) => return self.fail(*diagnostic),
        };
        let mut filled = Filled {
            arguments: Vec::with_capacity(bound.len()),
            places: Vec::with_capacity(bound.len()),
        };
        for (parameter, given) in entry.parameters.iter().zip(bound) {
            filled.places.push(given.as_ref().map(|given| given.span));
            filled.arguments.push(match (given, parameter.default) {
                (Some(given), _) => self.argument(entry, parameter, &given, is_planar)?,
                (None, Some(default)) => default(),
                (None, None) => return Err(super::machine::Stop),
            });
        }
        Ok(filled)
    }

    /// The value as the parameter wants it, within its range.
    fn argument(
        &mut self,
        entry: &Declaration,
        parameter: &Parameter,
        given: &Given,
        is_planar: bool,
    ) -> Eval<Argument> {
        let Some(argument) = converted(&given.value, parameter, is_planar) else {
            return self.wrong_kind(entry, parameter, given, is_planar);
        };
        let is_endless = |x: &f64| !x.is_finite() && !parameter.range.contains(*x);
        let problem = if argument.components().iter().any(is_endless) {
            Some("finite".into())
        } else if !argument
            .components()
            .iter()
            .all(|x| parameter.range.contains(*x))
        {
            Some(parameter.range_words())
        } else if parameter.kind == Kind::Count
            && argument.components().iter().any(|x| x.fract() != 0.0)
        {
            Some("a whole number".into())
        } else if parameter.kind == Kind::Direction && argument == Argument::Vector3([0.0; 3]) {
            Some("a direction, not zero".into())
        } else {
            None
        };
        let Some(words) = problem else {
            return Ok(argument);
        };
        let message = format!("`{}` of `{}` must be {words}", parameter.name, entry.name);
        let error = Diagnostic::error(given.span, message).label(given.value.shown());
        self.fail(error.help_if(default_help(parameter)))
    }

    fn wrong_kind<T>(
        &mut self,
        entry: &Declaration,
        parameter: &Parameter,
        given: &Given,
        is_planar: bool,
    ) -> Eval<T> {
        let (name, noun) = (parameter.name, parameter.kind.noun());
        let message = format!(
            "`{name}` of `{}` expects {noun}, but this is {}",
            entry.name,
            given.value.noun()
        );
        let error = Diagnostic::error(given.span, message).label(given.value.shown());
        let help = match (&given.value, parameter.kind) {
            (Value::Number(_), Kind::Angle) => {
                Some("angles carry a unit, as in `45deg`".to_string())
            }
            (Value::Symbolic(_), _) => Some(
                "the arguments of shapes are fixed; the point can only stand in the field's formula".into(),
            ),
            (Value::Text(_), Kind::Axis | Kind::Direction) => {
                Some("the axes are \"x\", \"y\" and \"z\"".into())
            }
            (Value::Vector2([x, y]), Kind::Vector3 | Kind::Factors) => {
                // Where 0 is not allowed, the third component is as large as the second.
                let z = if parameter.range.contains(0.0) { 0.0 } else { *y };
                Some(format!("in space there are three components: `[{x}, {y}, {z}]`"))
            }
            (Value::Angle(_), Kind::Number) => Some("lengths have no unit".into()),
            _ => None,
        };
        // Another parameter may be what it was meant for.
        let is_meant = |p: &&Parameter| converted(&given.value, p, is_planar).is_some();
        let meant = entry.parameters.iter().find(is_meant);
        let help = match (help, meant, &given.value) {
            (None, Some(p), Value::Text(text)) => Some(format!("write `{}: \"{text}\"`", p.name)),
            (help, _, _) => help.or_else(|| default_help(parameter)),
        };
        self.fail(error.help_if(help))
    }
}

fn default_help(parameter: &Parameter) -> Option<String> {
    parameter
        .default_in_words()
        .map(|default| format!("the default is {default}"))
}

/// The value as the parameter's kind wants it; none where it is of another kind.
fn converted(value: &Value, parameter: &Parameter, is_planar: bool) -> Option<Argument> {
    Some(match (parameter.kind, value) {
        (Kind::Number | Kind::Count, Value::Number(x)) => Argument::Number(*x),
        (Kind::Angle, Value::Angle(x)) => Argument::Angle(*x),
        (Kind::Vector2, Value::Vector2(v)) => Argument::Vector2(*v),
        (Kind::Vector3 | Kind::Factors | Kind::Direction, Value::Vector3(v)) => {
            Argument::Vector3(*v)
        }
        (Kind::Vector3, Value::Vector2([x, y])) if is_planar => {
            Argument::Vector3([*x, *y, third(parameter)])
        }
        (Kind::Factors, Value::Vector2([x, y])) if is_planar => Argument::Vector3([*x, *y, 1.0]),
        (Kind::Factors, Value::Number(x)) => Argument::Vector3([*x; 3]),
        (Kind::Direction, Value::Text(name)) => {
            let axis = AXES.iter().position(|axis| **axis == **name)?;
            let mut direction = [0.0; 3];
            direction[axis] = 1.0;
            Argument::Vector3(direction)
        }
        (Kind::Axis, Value::Text(name)) => {
            Argument::Axis(AXES.iter().position(|axis| **axis == **name)?)
        }
        (Kind::Points, Value::List(list)) => {
            let points = list.items.iter().map(|item| match item {
                Value::Vector2(v) => Some(*v),
                _ => None,
            });
            Argument::Points(points.collect::<Option<_>>()?)
        }
        (Kind::Points3, Value::List(list)) => {
            let points = list.items.iter().map(|item| match item {
                Value::Vector3(v) => Some(*v),
                _ => None,
            });
            Argument::Points3(points.collect::<Option<_>>()?)
        }
        _ => return None,
    })
}

/// What a profile's third component is: nothing happens along z.
fn third(parameter: &Parameter) -> f64 {
    match parameter.default.map(|default| default()) {
        Some(Argument::Vector3([_, _, z])) => z,
        _ => 0.0,
    }
}
