//! What follows an operand: calls of everything that can be called, with their arguments.

use super::arguments::Given;
use super::ast::*;
use super::builtin::Builtin;
use super::machine::{Eval, Machine};
use super::report::Diagnostic;
use super::source::Span;
use super::value::Value;

impl<'a> Machine<'a> {
    /// An operand with what follows it.
    pub fn postfix(&mut self, postfix: &'a Postfix) -> Eval<Value> {
        let mut value = self.eval(&postfix.base)?;
        let mut span = postfix.base.span;
        for step in &postfix.steps {
            self.tick(1, span)?;
            value = match step {
                Step::Member(word) => self.member(value, word)?,
                Step::Index(index) => self.index(&value, index)?,
                Step::Call(arguments) => {
                    let given = self.given(None, arguments)?;
                    let result = self.call(value, span, given)?;
                    span = span.to(arguments.span);
                    result
                }
                Step::Method(word, binding, arguments) => {
                    let callee = self.named(word, *binding)?;
                    let receiver = Given {
                        label: None,
                        value,
                        span,
                    };
                    let given = self.given(Some(receiver), arguments)?;
                    let result = self.call(callee, word.span, given)?;
                    span = span.to(arguments.span);
                    result
                }
            };
            if let Step::Member(word) = step {
                span = span.to(word.span);
            }
        }
        Ok(value)
    }

    /// The values of arguments.
    fn given(
        &mut self,
        receiver: Option<Given<'a>>,
        arguments: &'a Arguments,
    ) -> Eval<Vec<Given<'a>>> {
        let mut given = Vec::with_capacity(arguments.items.len() + 1);
        given.extend(receiver);
        for argument in &arguments.items {
            let is_blend = argument.label.as_ref().is_some_and(|l| &*l.text == "blend");
            let value = match is_blend {
                true => self.blend_value(&argument.value)?,
                false => self.eval(&argument.value)?,
            };
            given.push(Given {
                label: argument.label.as_ref(),
                value,
                span: argument.value.span,
            });
        }
        Ok(given)
    }

    /// The value of a `blend:` argument: there a blend's name comes before a function of the same name.
    fn blend_value(&mut self, expression: &'a Expression) -> Eval<Value> {
        if let Kind::Postfix(postfix) = &expression.kind
            && let Kind::Name(word, Binding::Builtin(_)) = &postfix.base.kind
            && let [Step::Call(arguments)] = &postfix.steps[..]
            && let Some(entry) = Builtin::blend(&word.text)
        {
            let given = self.given(None, arguments)?;
            let blend = Value::Builtin(Builtin::Blend(entry));
            return self.call(blend, word.span, given);
        }
        self.eval(expression)
    }

    /// Calls any value that can be called.
    pub fn call(&mut self, callee: Value, at: Span, given: Vec<Given<'a>>) -> Eval<Value> {
        match callee {
            Value::Routine(RoutineKind::Function, id) => self.call_routine(id, at, given),
            Value::Routine(RoutineKind::Field, id) => self.call_field(id, at, given),
            Value::Routine(RoutineKind::Pattern, id) => self.call_pattern(id, at, given),
            Value::Builtin(Builtin::Primitive(entry)) => self.primitive(entry, at, given),
            Value::Builtin(Builtin::Modifier(entry)) => self.modifier(entry, at, given),
            Value::Builtin(Builtin::Blend(entry)) => self.blend(entry, at, given),
            Value::Builtin(Builtin::Operation(operation)) => self.operation(operation, at, given),
            Value::Builtin(Builtin::Function(function)) => self.function(function, at, given),
            Value::Builtin(Builtin::Intrinsic(intrinsic)) => self.intrinsic(intrinsic, at, given),
            Value::Pattern(pattern) => match &given[..] {
                [point] if point.label.is_none() => self.pattern_at(&pattern, &point.value, at),
                _ => {
                    let message = "a pattern is taken at one point [x, y, z]";
                    self.fail(Diagnostic::error(at, message))
                }
            },
            other => {
                let message = format!("{} cannot be called", other.noun());
                self.fail(Diagnostic::error(at, message).label(other.shown()))
            }
        }
    }

    /// Calls a function of the script, a field at a point, or a pattern at a point.
    pub fn call_routine(&mut self, id: GlobalId, at: Span, given: Vec<Given<'a>>) -> Eval<Value> {
        self.with_frame(id, at, given, |machine, routine| {
            machine.block(&routine.body)
        })
    }
}
