//! The catalogue's functions of numbers, applied to vectors and colours by components.

use super::arguments::{Given, bind};
use super::machine::{Eval, Machine, item_of};
use super::report::Diagnostic;
use super::source::Span;
use super::value::{Form, Quantity, Scalar, Value};
use crate::catalogue::Function;

impl<'a> Machine<'a> {
    /// A function of the catalogue, by components.
    pub fn function(&mut self, function: Function, at: Span, given: Vec<Given<'a>>) -> Eval<Value> {
        if let Some(fold) = self.folded(function, &given, at)? {
            return Ok(fold);
        }
        let slots: Vec<_> = function
            .arguments()
            .iter()
            .map(|name| (*name, true))
            .collect();
        let bound = match bind(function.name(), &slots, at, given) {
            Ok(bound) => bound,
            Err(diagnostic) => return self.fail(*diagnostic),
        };
        let mut quantities = Vec::with_capacity(3);
        for given in bound.iter().flatten() {
            match given.value.quantity() {
                Some(quantity) => quantities.push(quantity),
                None => {
                    let message = format!(
                        "`{}` works on numbers, but this is {}",
                        function.name(),
                        given.value.noun()
                    );
                    let error = Diagnostic::error(given.span, message).label(given.value.shown());
                    return self.fail(error);
                }
            }
        }
        let Some((form, count)) = function_form(function, &quantities) else {
            let nouns: Vec<String> = bound
                .iter()
                .flatten()
                .map(|given| given.value.noun().into())
                .collect();
            let nouns = super::hint::joined(&nouns, "and");
            let message = format!("`{}` does not work on {nouns}", function.name());
            return self.fail(Diagnostic::error(at, message));
        };
        let mut result = [Scalar::Known(0.0); 3];
        for (i, scalar) in result[..count].iter_mut().enumerate() {
            let mut arguments = [Scalar::Known(0.0); 3];
            for (argument, quantity) in arguments.iter_mut().zip(&quantities) {
                *argument = quantity.component(i);
            }
            *scalar = self.apply(function, &arguments[..quantities.len()]);
        }
        self.check_graph(at)?;
        Ok(Quantity::new(form, &result[..count]).value())
    }

    /// The smallest or largest of a list, or of more than two arguments; none for other calls.
    fn folded(&mut self, function: Function, given: &[Given<'a>], at: Span) -> Eval<Option<Value>> {
        if !matches!(function, Function::Min | Function::Max) {
            return Ok(None);
        }
        let items: Vec<Value> = match given {
            [only] if only.label.is_none() => {
                let count = self.count_of(&only.value, only.span)?;
                (0..count).map(|i| item_of(&only.value, i)).collect()
            }
            [_, _, _, ..] if given.iter().all(|g| g.label.is_none()) => {
                given.iter().map(|g| g.value.clone()).collect()
            }
            _ => return Ok(None),
        };
        self.tick(items.len() as u64, at)?;
        let mut items = items.into_iter();
        let Some(mut best) = items.next() else {
            let message = format!("an empty list has no `{}`", function.name());
            return self.fail(Diagnostic::error(at, message));
        };
        for item in items {
            let pair = [best, item].map(|value| Given {
                label: None,
                value,
                span: at,
            });
            best = self.function(function, at, pair.to_vec())?;
        }
        Ok(Some(best))
    }
}

/// The form of a function's value; none where it has no meaning for these arguments.
fn function_form(function: Function, quantities: &[Quantity]) -> Option<(Form, usize)> {
    let is_angle = |q: &Quantity| q.form == Form::Angle;
    if !quantities.iter().any(is_angle) {
        return quantities.iter().skip(1).try_fold(
            (quantities[0].form, quantities[0].count),
            |(form, count), q| match (form, q.form) {
                (_, Form::Number) => Some((form, count)),
                (Form::Number, _) => Some((q.form, q.count)),
                (a, b) if a == b && count == q.count => Some((form, count)),
                _ => None,
            },
        );
    }
    match function {
        Function::Sin | Function::Cos | Function::Tan => Some((Form::Number, 1)),
        Function::Abs | Function::Min | Function::Max | Function::Clamp | Function::Modulo
            if quantities.iter().all(is_angle) =>
        {
            Some((Form::Angle, 1))
        }
        Function::Mix
            if quantities[..2].iter().all(is_angle) && quantities[2].form == Form::Number =>
        {
            Some((Form::Angle, 1))
        }
        _ => None,
    }
}
