//! Values as shapes, and shapes combined.

use super::arguments::Given;
use super::ast::RoutineKind;
use super::machine::{Eval, Machine};
use super::report::Diagnostic;
use super::source::Span;
use super::value::Value;
use crate::catalogue::{AnyBlend, Combination, Operation};
use crate::scene::{Material, Node};
use std::sync::Arc;

impl<'a> Machine<'a> {
    /// The value as one shape: a field as it is, a list as the union of its shapes.
    pub fn shape(&mut self, value: &Value, at: Span) -> Eval<Arc<Node>> {
        match value {
            Value::Shape(node) => Ok(node.clone()),
            Value::Routine(RoutineKind::Field, id) => self.field_shape(*id, at),
            Value::List(_) => {
                let mut all = Vec::new();
                self.gather(value, at, &mut all)?;
                match self.combined(Operation::Union, AnyBlend::HARD, all, at)? {
                    Value::Shape(node) => Ok(node),
                    other => self.no_shape(&other, at),
                }
            }
            other => self.no_shape(other, at),
        }
    }

    fn no_shape<T>(&mut self, value: &Value, at: Span) -> Eval<T> {
        let message = format!("a shape is expected, but this is {}", value.noun());
        let error = Diagnostic::error(at, message).label(value.shown());
        self.fail(match value {
            Value::Builtin(builtin) => {
                error.help(format!("call it, as in `{}(...)`", builtin.name()))
            }
            Value::Routine(..) => error.help("call it: `f(x)`"),
            Value::Blend(_) => {
                error.help("a blend is given by name, as in `union(a, b, blend: smooth(0.2))`")
            }
            _ => error,
        })
    }

    /// Adds the shapes of the value, a shape or nested lists of them.
    pub fn gather(&mut self, value: &Value, at: Span, all: &mut Vec<Arc<Node>>) -> Eval<()> {
        match value {
            Value::List(list) => {
                self.tick(list.items.len() as u64 / 4, at)?;
                for item in &list.items {
                    self.gather(item, at, all)?;
                }
                Ok(())
            }
            other => {
                all.push(self.shape(other, at)?);
                Ok(())
            }
        }
    }

    /// A value as operands of an operator: a list is united, except where it only adds operands to the same operation.
    pub fn operands(
        &mut self,
        operation: Operation,
        value: Value,
        at: Span,
    ) -> Eval<Vec<Arc<Node>>> {
        if operation == Operation::Union {
            let mut all = Vec::new();
            self.gather(&value, at, &mut all)?;
            return Ok(all);
        }
        Ok(vec![self.shape(&value, at)?])
    }

    /// Several shapes as one.
    pub fn combined(
        &mut self,
        operation: Operation,
        blend: AnyBlend,
        children: Vec<Arc<Node>>,
        at: Span,
    ) -> Eval<Value> {
        self.tick(children.len() as u64 / 4, at)?;
        match Node::combination(Combination { operation, blend }, children) {
            Ok(node) => self.made(node, at),
            Err(fault) => self.fault(fault, at),
        }
    }

    /// `union(a, b, ..., blend: smooth(k))` and the like.
    pub fn operation(
        &mut self,
        operation: Operation,
        at: Span,
        given: Vec<Given<'a>>,
    ) -> Eval<Value> {
        let name = operation.name();
        let mut blend = None;
        let mut all = Vec::new();
        for argument in given {
            let Some(label) = argument.label else {
                self.gather(&argument.value, argument.span, &mut all)?;
                continue;
            };
            if &*label.text != "blend" {
                let message = format!(
                    "`{name}` has no argument `{}`",
                    super::hint::clipped(&label.text)
                );
                let help = super::hint::nearest(&label.text, ["blend"]).map_or(
                    "it takes shapes, lists of shapes, and `blend`",
                    |_| "did you mean `blend`?",
                );
                return self.fail(Diagnostic::error(label.span, message).help(help));
            }
            if blend.is_some() {
                let message = format!("`blend` of `{name}` is given twice");
                return self.fail(Diagnostic::error(label.span, message));
            }
            blend = Some(self.blend_of(name, &argument)?);
        }
        self.combined(operation, blend.unwrap_or(AnyBlend::HARD), all, at)
    }

    fn blend_of(&mut self, name: &str, argument: &Given) -> Eval<AnyBlend> {
        if let Value::Blend(blend) = &argument.value {
            return Ok((**blend).clone());
        }
        let message = format!(
            "`blend` of `{name}` expects a blend, but this is {}",
            argument.value.noun()
        );
        let error = Diagnostic::error(argument.span, message).label(argument.value.shown());
        self.fail(match &argument.value {
            Value::Number(k) => error.help(format!("write `smooth({k})`")),
            _ => error.help("as in `blend: smooth(0.2)`"),
        })
    }

    /// The shape, or each shape of a list, in a material.
    pub fn painted(&mut self, value: &Value, material: &Arc<Material>, at: Span) -> Eval<Value> {
        if let Value::List(list) = value {
            let painted = list
                .items
                .iter()
                .map(|item| self.painted(item, material, at))
                .collect::<Eval<Vec<_>>>()?;
            return self.listed(painted, at);
        }
        let node = self.shape(value, at)?;
        self.made(node.painted(material.clone()), at)
    }

    /// The value with every shape in it labelled with the name and place of its statement.
    pub fn labelled(&mut self, value: Value, name: Option<&Arc<str>>, at: Span) -> Eval<Value> {
        match value {
            Value::Shape(node) => {
                let place = self.place(at);
                self.made(node.labelled(name.cloned(), Some(place)), at)
            }
            Value::List(list) if has_shapes(&list.items) => {
                let labelled = list
                    .items
                    .iter()
                    .map(|item| self.labelled(item.clone(), name, at))
                    .collect::<Eval<Vec<_>>>()?;
                self.listed(labelled, at)
            }
            other => Ok(other),
        }
    }
}

/// Whether shapes are in the list, or in its first list.
fn has_shapes(items: &[Value]) -> bool {
    match items.first() {
        Some(Value::Shape(_)) => true,
        Some(Value::List(list)) => has_shapes(&list.items),
        _ => items.iter().any(|item| matches!(item, Value::Shape(_))),
    }
}
