//! Operators on values of all kinds.

use super::ast::*;
use super::machine::{Eval, Machine};
use super::numeric::Arithmetic;
use super::report::Diagnostic;
use super::source::Span;
use super::value::{Form, Quantity, Scalar, Value};
use crate::catalogue::{AnyBlend, Operation};

impl<'a> Machine<'a> {
    /// Operators of one level, from left to right. Shapes are gathered, so that a long union is one node.
    pub fn chain(&mut self, chain: &'a Chain, at: Span) -> Eval<Value> {
        let mut value = self.eval(&chain.first)?;
        let mut span = chain.first.span;
        let mut rest = chain.rest.iter().peekable();
        while let Some((operator, _, operand)) = rest.next() {
            let Some(operation) = self.set_operation(*operator, &value) else {
                let right = self.eval(operand)?;
                value = self.binary(*operator, (value, span), (right, operand.span))?;
                span = span.to(operand.span);
                continue;
            };
            let mut operands = self.operands(operation, value, span)?;
            let right = self.eval(operand)?;
            operands.extend(self.operands(operation, right, operand.span)?);
            span = span.to(operand.span);
            while let Some((_, _, operand)) = rest.next_if(|(next, ..)| next == operator) {
                let right = self.eval(operand)?;
                operands.extend(self.operands(operation, right, operand.span)?);
                span = span.to(operand.span);
            }
            self.tick(operands.len() as u64, at)?;
            value = self.combined(operation, AnyBlend::HARD, operands, span)?;
        }
        Ok(value)
    }

    /// The set operation that an operator means with this value on its left.
    fn set_operation(&self, operator: Operator, left: &Value) -> Option<Operation> {
        match operator {
            Operator::Unite => Some(Operation::Union),
            Operator::Intersect => Some(Operation::Intersection),
            Operator::Subtract if left.is_shape() => Some(Operation::Difference),
            _ => None,
        }
    }

    /// `a operator b` for anything but sets.
    pub fn binary(
        &mut self,
        operator: Operator,
        (a, at_a): (Value, Span),
        (b, at_b): (Value, Span),
    ) -> Eval<Value> {
        if let (Value::Number(x), Value::Number(y)) = (&a, &b) {
            let result = match operator {
                Operator::Add => x + y,
                Operator::Subtract => x - y,
                Operator::Multiply => x * y,
                Operator::Divide => x / y,
                _ => return self.joined_numbers(operator, &a, &b, (at_a, at_b)),
            };
            return Ok(Value::Number(result));
        }
        if let (Operator::Add, Value::Text(x), Value::Text(y)) = (operator, &a, &b) {
            return self.joined_text(&[x, y], at_a.to(at_b));
        }
        self.joined_numbers(operator, &a, &b, (at_a, at_b))
    }

    /// `a operator b` for numbers, angles, vectors and colours.
    fn joined_numbers(
        &mut self,
        operator: Operator,
        a: &Value,
        b: &Value,
        at: (Span, Span),
    ) -> Eval<Value> {
        let arithmetic = match operator {
            Operator::Add => Arithmetic::Add,
            Operator::Subtract => Arithmetic::Subtract,
            Operator::Multiply => Arithmetic::Multiply,
            Operator::Divide => Arithmetic::Divide,
            _ => Arithmetic::Remainder,
        };
        let quantities = a.quantity().zip(b.quantity());
        let form = quantities.and_then(|(x, y)| result_form(arithmetic, &x, &y));
        let (Some((x, y)), Some((form, count))) = (quantities, form) else {
            return self.no_operation(operator.mark(), a, b, at);
        };
        let mut result = [Scalar::Known(0.0); 3];
        for (i, scalar) in result[..count].iter_mut().enumerate() {
            *scalar = self.arithmetic(arithmetic, x.component(i), y.component(i));
        }
        self.check_graph(at.0.to(at.1))?;
        Ok(Quantity::new(form, &result[..count]).value())
    }

    fn no_operation<T>(&mut self, mark: &str, a: &Value, b: &Value, at: (Span, Span)) -> Eval<T> {
        let message = format!("`{mark}` does not join {} and {}", a.noun(), b.noun());
        let error = Diagnostic::error(at.0.to(at.1), message);
        let angles = [a, b].map(|v| matches!(v, Value::Angle(_)));
        let numbers = [a, b].map(|v| matches!(v, Value::Number(_)));
        let is_shape = [a, b].iter().any(|v| matches!(v, Value::Shape(_)));
        let is_text = [a, b].iter().any(|v| matches!(v, Value::Text(_)));
        self.fail(match mark {
            "+" if is_shape => error.help("a union is written `a | b`"),
            "*" if is_shape => error.help("shapes grow with `.scale(factor)`"),
            "+" if is_text => error.help("turn other values into strings with `str(value)`"),
            _ if angles[0] && numbers[1] || numbers[0] && angles[1] => {
                error.help("angles carry a unit, as in `45deg`")
            }
            _ => error,
        })
    }

    /// `a ^ b`
    pub fn power(&mut self, a: &'a Expression, b: &'a Expression, at: Span) -> Eval<Value> {
        let (base, exponent) = (self.eval(a)?, self.eval(b)?);
        let quantities = base.quantity().zip(exponent.quantity());
        let form = quantities.and_then(|(x, y)| Self::joined_form(&x, &y));
        let (Some((x, y)), Some((form, count))) = (quantities, form) else {
            return self.no_operation("^", &base, &exponent, (a.span, b.span));
        };
        let mut result = [Scalar::Known(0.0); 3];
        for (i, scalar) in result[..count].iter_mut().enumerate() {
            *scalar = self.arithmetic(Arithmetic::Power, x.component(i), y.component(i));
        }
        self.check_graph(at)?;
        Ok(Quantity::new(form, &result[..count]).value())
    }

    /// `-a`
    pub fn negate(&mut self, operand: &'a Expression) -> Eval<Value> {
        let value = self.eval(operand)?;
        let Some(quantity) = value.quantity() else {
            let message = format!("`-` needs a number, but this is {}", value.noun());
            return self.fail(Diagnostic::error(operand.span, message).label(value.shown()));
        };
        let mut result = [Scalar::Known(0.0); 3];
        for (scalar, x) in result.iter_mut().zip(quantity.scalars()) {
            *scalar = self.negated(*x);
        }
        Ok(Quantity::new(quantity.form, &result[..quantity.count]).value())
    }

    /// `not a`
    pub fn not(&mut self, operand: &'a Expression) -> Eval<Value> {
        match self.eval(operand)? {
            Value::Bool(holds) => Ok(Value::Bool(!holds)),
            Value::Condition(mut condition) => {
                condition.is_negated = !condition.is_negated;
                Ok(Value::Condition(condition))
            }
            value => self.no_condition(&value, operand.span),
        }
    }

    /// `a and b`, `a or b`: stops at the first that decides.
    pub fn logic(&mut self, connective: Connective, items: &'a [Expression]) -> Eval<Value> {
        let decisive = connective == Connective::Or;
        let mut so_far = Value::Bool(!decisive);
        for item in items {
            let value = match self.eval(item)? {
                Value::Bool(holds) if holds == decisive => return Ok(Value::Bool(decisive)),
                Value::Bool(_) => continue,
                value @ Value::Condition(_) => value,
                value => return self.no_condition(&value, item.span),
            };
            so_far = match so_far {
                Value::Condition(condition) => {
                    let right = self.flag(&value);
                    let flag = match connective {
                        Connective::And => self.choose(condition, right, Scalar::Known(0.0)),
                        Connective::Or => self.choose(condition, Scalar::Known(1.0), right),
                    };
                    self.condition(flag)
                }
                _ => value,
            };
        }
        Ok(so_far)
    }

    /// `a < b` and the like.
    pub fn compare(&mut self, compare: &'a Compare, at: Span) -> Eval<Value> {
        let (left, right) = (self.eval(&compare.left)?, self.eval(&compare.right)?);
        self.compared(compare.comparison, &left, &right, at)
    }

    /// Whether the comparison holds.
    pub fn compared(
        &mut self,
        comparison: Comparison,
        left: &Value,
        right: &Value,
        at: Span,
    ) -> Eval<Value> {
        if let (Value::Number(a), Value::Number(b)) = (left, right) {
            return Ok(Value::Bool(match comparison {
                Comparison::Less => a < b,
                Comparison::LessEqual => a <= b,
                Comparison::Greater => a > b,
                Comparison::GreaterEqual => a >= b,
                Comparison::Equal => a == b,
                Comparison::NotEqual => a != b,
            }));
        }
        let is_equality = matches!(comparison, Comparison::Equal | Comparison::NotEqual);
        if is_equality && let Some(is_equal) = equal(left, right) {
            return Ok(Value::Bool(is_equal == (comparison == Comparison::Equal)));
        }
        let quantities = left.quantity().zip(right.quantity());
        if let Some((a, b)) = quantities
            && a.form == b.form
            && a.count == 1
            && b.count == 1
        {
            return self.ordered(comparison, a.scalars[0], b.scalars[0]);
        }
        let mark = comparison.mark();
        let message = format!(
            "`{mark}` does not compare {} with {}",
            left.noun(),
            right.noun()
        );
        let error = Diagnostic::error(at, message);
        let is_angle = |v: &Value| matches!(v, Value::Angle(_));
        self.fail(match is_angle(left) != is_angle(right) {
            true => error.help("angles carry a unit, as in `45deg`"),
            false => error,
        })
    }

    fn ordered(&mut self, comparison: Comparison, a: Scalar, b: Scalar) -> Eval<Value> {
        Ok(match comparison {
            Comparison::Less => self.less(a, b, false),
            Comparison::GreaterEqual => self.less(a, b, true),
            Comparison::Greater => self.less(b, a, false),
            Comparison::LessEqual => self.less(b, a, true),
            Comparison::Equal | Comparison::NotEqual => {
                let (below, above) = (self.less(a, b, false), self.less(b, a, false));
                let (below, above) = (self.flag(&below), self.flag(&above));
                let apart = self.arithmetic(Arithmetic::Add, below, above);
                let half = Scalar::Known(0.5);
                match comparison {
                    Comparison::Equal => self.less(apart, half, false),
                    _ => self.less(half, apart, false),
                }
            }
        })
    }
}

/// The form of `a operation b`; none where it has no meaning.
fn result_form(operation: Arithmetic, a: &Quantity, b: &Quantity) -> Option<(Form, usize)> {
    use Arithmetic::*;
    match (a.form, operation, b.form) {
        (Form::Angle, Divide, Form::Angle) => Some((Form::Number, 1)),
        (Form::Angle, Add | Subtract | Remainder, Form::Angle) => Some((Form::Angle, 1)),
        (Form::Angle, Multiply | Divide, Form::Number) => Some((Form::Angle, 1)),
        (Form::Number, Multiply, Form::Angle) => Some((Form::Angle, 1)),
        (Form::Angle, ..) | (.., Form::Angle) => None,
        _ => Machine::joined_form(a, b),
    }
}

/// Whether two values are equal; none where that cannot be said.
pub(super) fn equal(a: &Value, b: &Value) -> Option<bool> {
    Some(match (a, b) {
        (Value::Number(a), Value::Number(b)) | (Value::Angle(a), Value::Angle(b)) => a == b,
        (Value::Bool(a), Value::Bool(b)) => a == b,
        (Value::Text(a), Value::Text(b)) => a == b,
        (Value::Vector2(a), Value::Vector2(b)) => a == b,
        (Value::Vector3(a), Value::Vector3(b)) | (Value::Color(a), Value::Color(b)) => a == b,
        (Value::Vector2(_), Value::Vector3(_)) | (Value::Vector3(_), Value::Vector2(_)) => false,
        (Value::List(a), Value::List(b)) => {
            if a.items.len() != b.items.len() {
                return Some(false);
            }
            for (x, y) in a.items.iter().zip(&b.items) {
                if !equal(x, y)? {
                    return Some(false);
                }
            }
            true
        }
        _ => return None,
    })
}
