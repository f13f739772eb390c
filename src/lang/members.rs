//! What stands after a point, and in brackets: components, elements, answers of shapes and rays.

use super::ast::{Expression, RoutineKind};
use super::hint::{clipped, did_you_mean, listed};
use super::machine::{Eval, Machine, component_of, item_of};
use super::report::Diagnostic;
use super::source::Word;
use super::value::{Form, Value};
use crate::scene::TraceRecord;
use std::sync::Arc;

impl<'a> Machine<'a> {
    /// `value.word`
    pub fn member(&mut self, value: Value, word: &Word) -> Eval<Value> {
        if let Some(quantity) = value.quantity() {
            let names: &[&str] = match quantity.form {
                Form::Vector => &["x", "y", "z"][..quantity.count],
                Form::Color => &["r", "g", "b"],
                _ => &[],
            };
            return match names.iter().position(|name| **name == *word.text) {
                Some(i) => Ok(component_of(&quantity, i)),
                None => self.no_member(&value, word, names),
            };
        }
        match &value {
            Value::Shape(_) | Value::Routine(RoutineKind::Field, _) => {
                self.shape_member(&value, word)
            }
            Value::List(list) if matches!(list.items.first(), Some(Value::Shape(_))) => {
                self.shape_member(&value, word)
            }
            Value::Bounds(bounds) => match &*word.text {
                "min" => Ok(Value::Vector3(bounds.low)),
                "max" => Ok(Value::Vector3(bounds.high)),
                "size" => Ok(Value::Vector3(bounds.size())),
                "center" => Ok(Value::Vector3(bounds.centre())),
                _ => self.no_member(&value, word, &["min", "max", "size", "center"]),
            },
            Value::Trace(record) => self.trace_member(&record.clone(), word),
            _ => self.no_member(&value, word, &[]),
        }
    }

    fn shape_member(&mut self, value: &Value, word: &Word) -> Eval<Value> {
        let names = ["lipschitz", "bounds", "class"];
        if !names.contains(&&*word.text) {
            return self.no_member(value, word, &names);
        }
        let node = self.shape(value, word.span)?;
        Ok(match &*word.text {
            "lipschitz" => Value::Number(node.lipschitz()),
            "bounds" => Value::Bounds(Arc::new(node.bounds())),
            _ => Value::Text(node.class().word().into()),
        })
    }

    fn trace_member(&mut self, record: &TraceRecord, word: &Word) -> Eval<Value> {
        let is_hit = record.verdict == "hit";
        Ok(match &*word.text {
            "hit" => Value::Bool(is_hit),
            "t" if is_hit => Value::Number(record.t),
            "t" => Value::Number(f64::INFINITY),
            "steps" => Value::Number(f64::from(record.steps)),
            "evaluations" => Value::Number(f64::from(record.evaluations)),
            "verdict" => Value::Text(record.verdict.into()),
            "point" | "normal" if !is_hit => {
                let message = format!("the ray hit nothing, so it has no `{}`", word.text);
                let error = Diagnostic::error(word.span, message);
                return self.fail(error.label(format!("its verdict is \"{}\"", record.verdict)));
            }
            "point" => Value::Vector3(record.point),
            "normal" => Value::Vector3(record.normal),
            _ => {
                let names = [
                    "hit",
                    "t",
                    "point",
                    "normal",
                    "steps",
                    "evaluations",
                    "verdict",
                ];
                return self.no_member(&Value::Trace(Arc::new(*record)), word, &names);
            }
        })
    }

    fn no_member<T>(&mut self, value: &Value, word: &Word, names: &[&str]) -> Eval<T> {
        let name = clipped(&word.text);
        let message = format!("{} has no `.{name}`", value.noun());
        let error = Diagnostic::error(word.span, message);
        if super::builtin::Builtin::named(&word.text).is_some() {
            return self.fail(error.help(format!("a function needs parentheses: `.{name}(...)`")));
        }
        let help = match did_you_mean(&word.text, names.iter().copied()) {
            Some(help) if help.starts_with("did") => Some(help),
            _ if names.is_empty() => None,
            _ => Some(format!("it has {}", listed(names, "and"))),
        };
        self.fail(error.help_if(help))
    }

    /// `value[index]`
    pub fn index(&mut self, value: &Value, index: &'a Expression) -> Eval<Value> {
        let count = self.count_of(value, index.span)?;
        let at = self.eval(index)?;
        let Value::Number(x) = at else {
            let message = format!("an index is a whole number, but this is {}", at.noun());
            return self.fail(Diagnostic::error(index.span, message).label(at.shown()));
        };
        if x.fract() == 0.0 && x >= 0.0 && x < count as f64 {
            return Ok(item_of(value, x as usize));
        }
        let message = match count {
            0 => "the list is empty".into(),
            n => format!("the index must be a whole number from 0 to {}", n - 1),
        };
        self.fail(Diagnostic::error(index.span, message).label(at.shown()))
    }
}
