//! What shapes and rays answer in expressions.

use super::arguments::Given;
use super::machine::{Eval, Machine};
use super::report::Diagnostic;
use super::source::Span;
use super::value::{Form, Scalar, Value};
use crate::num::Vec3;
use std::sync::Arc;

impl<'a> Machine<'a> {
    /// The field of a shape at a point, which may be that of a field that is being made.
    pub fn at(&mut self, shape: &Given, point: &Given) -> Eval<Value> {
        let node = self.shape(&shape.value, shape.span)?;
        let quantity = point.value.quantity();
        let is_planar = node.traits().is_planar;
        let scalars = match quantity {
            Some(q) if q.form == Form::Vector && (q.count == 3 || is_planar) => q.scalars,
            _ => return self.unfit(point, "at", "a point [x, y, z]"),
        };
        self.tick(node.size(), point.span)?;
        if let [Scalar::Known(x), Scalar::Known(y), Scalar::Known(z)] = scalars {
            return Ok(Value::Number(node.evaluate(&Vec3::new(x, y, z))));
        }
        let ids = scalars.map(|scalar| self.id(scalar));
        let id = self.builder().shape(&node, ids);
        self.number(Scalar::Symbolic(id), point.span)
    }

    /// `trace(origin, direction)` through everything shown, or `shape.trace(origin, direction)`.
    pub fn trace(&mut self, at: Span, given: &[Given<'a>]) -> Eval<Value> {
        let (shown, rest) = match given {
            [shape, origin, direction] => (
                vec![self.shape(&shape.value, shape.span)?],
                [origin, direction],
            ),
            [origin, direction] => (self.shown.clone(), [origin, direction]),
            _ => {
                let message = "`trace` takes an origin and a direction";
                let help = "as in `trace([0, 0, 5], [0, 0, -1])`";
                return self.fail(Diagnostic::error(at, message).help(help));
            }
        };
        let origin = self.known_point(rest[0], "trace")?;
        let direction = self.known_point(rest[1], "trace")?;
        let length = direction.iter().fold(0.0, |n: f64, c| n.hypot(*c));
        if length == 0.0 || !length.is_finite() || origin.iter().any(|c| !c.is_finite()) {
            let message = "a ray needs a finite origin and a direction that is not zero";
            return self.fail(Diagnostic::error(rest[1].span, message));
        }
        let size: u64 = shown.iter().map(|node| node.size()).sum();
        self.tick(1000 + size, at)?;
        let found = self.tracer.trace(&shown, &self.settings, origin, direction);
        match found {
            Ok(record) => {
                self.fates.count(&record);
                Ok(Value::Trace(Arc::new(record)))
            }
            Err(problem) => self.fail(Diagnostic::error(at, problem)),
        }
    }

    /// The components of a known point.
    pub fn known_point(&mut self, given: &Given, callee: &str) -> Eval<[f64; 3]> {
        match given.value {
            Value::Vector3(p) => Ok(p),
            _ => self.unfit(given, callee, "a vector [x, y, z]"),
        }
    }
}
