//! Arguments find their parameters: first by position, then by name.

use super::hint::{clipped, counted, did_you_mean, listed};
use super::report::Diagnostic;
use super::source::{Span, Word};
use super::value::Value;

/// An argument with its value.
#[derive(Clone, Debug)]
pub(super) struct Given<'a> {
    /// The name before the colon, if any.
    pub label: Option<&'a Word>,
    pub value: Value,
    pub span: Span,
}

/// The arguments in the order of the parameters, each of which has a name and may have to be given.
///
/// # Errors
/// What is wrong with the first argument that fits nowhere, or that a parameter is missing.
pub(super) fn bind<'a>(
    callee: &str,
    parameters: &[(&str, bool)],
    at: Span,
    given: Vec<Given<'a>>,
) -> Result<Vec<Option<Given<'a>>>, Box<Diagnostic>> {
    let names = || parameters.iter().map(|(name, _)| *name);
    let mut bound: Vec<Option<Given<'a>>> = vec![None; parameters.len()];
    let count = given.len();
    let mut is_named = false;
    for (i, argument) in given.into_iter().enumerate() {
        let slot = match argument.label {
            None if is_named => {
                let message = "positional arguments come before named ones";
                return Err(Box::new(Diagnostic::error(argument.span, message)));
            }
            None if i >= parameters.len() => {
                let takes = counted(parameters.len(), "argument");
                let message = format!("`{callee}` takes {takes}, but {count} are given");
                let error = Diagnostic::error(argument.span, message).label("too many");
                return Err(Box::new(error.help_if(takes_help(parameters))));
            }
            None => i,
            Some(label) => {
                is_named = true;
                let Some(slot) = names().position(|name| name == &*label.text) else {
                    let message = format!("`{callee}` has no argument `{}`", clipped(&label.text));
                    let error = Diagnostic::error(label.span, message);
                    return Err(Box::new(
                        error.help_if(did_you_mean(&label.text, names().collect::<Vec<_>>())),
                    ));
                };
                slot
            }
        };
        if let Some(first) = &bound[slot] {
            let span = argument.label.map_or(argument.span, |label| label.span);
            let message = format!("`{}` of `{callee}` is given twice", parameters[slot].0);
            let error = Diagnostic::error(span, message).note(first.span, "first given here");
            return Err(Box::new(error));
        }
        bound[slot] = Some(argument);
    }
    let is_missing = |i: &usize| parameters[*i].1 && bound[*i].is_none();
    if let Some(missing) = (0..parameters.len()).find(is_missing) {
        let message = format!("`{}` of `{callee}` is missing", parameters[missing].0);
        let error = Diagnostic::error(at, message).help_if(takes_help(parameters));
        return Err(Box::new(error));
    }
    Ok(bound)
}

fn takes_help(parameters: &[(&str, bool)]) -> Option<String> {
    let names: Vec<&str> = parameters.iter().map(|(name, _)| *name).collect();
    (!names.is_empty()).then(|| format!("it takes {}", listed(&names, "and")))
}
