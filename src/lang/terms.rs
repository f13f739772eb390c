//! Blocks of `name: value`: each name once, each value of its kind and range.

use super::ast::Entry;
use super::hint::{clipped, did_you_mean, joined};
use super::machine::{Eval, Machine};
use super::report::Diagnostic;
use super::source::{Span, Word};
use super::value::Value;
use glam::DVec3;

/// The evaluated entries of a block. What is wrong with one does not keep the others from being checked.
pub(super) struct Terms<'a> {
    /// What the block is, for messages: `camera`.
    pub word: &'a str,
    /// Where the block's word stands.
    pub span: Span,
    items: Vec<(&'a Word, Value, Span)>,
    /// Whether something was wrong.
    pub is_broken: bool,
}

impl<'a> Terms<'a> {
    /// Evaluates the entries of a block that knows the words `known`.
    pub fn new(
        machine: &mut Machine<'a>,
        (word, span): (&'a str, Span),
        entries: &'a [Entry],
        known: &[&str],
    ) -> Self {
        let mut terms = Self {
            word,
            span,
            items: Vec::new(),
            is_broken: false,
        };
        for entry in entries {
            let name = &entry.name;
            if !known.contains(&&*name.text) {
                let message = format!("`{word}` has no `{}`", clipped(&name.text));
                let error = Diagnostic::error(name.span, message)
                    .help_if(did_you_mean(&name.text, known.iter().copied()));
                terms.note(machine, error);
                continue;
            }
            if let Some((first, ..)) = terms.items.iter().find(|(n, ..)| n.text == name.text) {
                let message = format!("`{}` of `{word}` is given twice", name.text);
                let error = Diagnostic::error(name.span, message);
                let error = error.note(first.span, "first given here");
                terms.note(machine, error);
                continue;
            }
            match machine.eval(&entry.value) {
                Ok(value) => terms.items.push((name, value, entry.value.span)),
                Err(_) => terms.is_broken = true,
            }
        }
        terms
    }

    /// Reports an error of the block.
    pub fn note(&mut self, machine: &mut Machine<'a>, diagnostic: Diagnostic) {
        self.is_broken = true;
        let _: Eval<()> = machine.fail(diagnostic);
    }

    /// The value of an entry with its place.
    pub fn get(&self, name: &str) -> Option<(Value, Span)> {
        let (_, value, span) = self.items.iter().find(|(word, ..)| &*word.text == name)?;
        Some((value.clone(), *span))
    }

    /// Where an entry stands, or else the block's word.
    pub fn place(&self, name: &str) -> Span {
        self.get(name).map_or(self.span, |(_, span)| span)
    }

    /// Reports a value of the wrong kind.
    pub fn wrong_kind(
        &mut self,
        machine: &mut Machine<'a>,
        name: &str,
        wanted: &str,
        help: Option<&str>,
    ) {
        let Some((value, span)) = self.get(name) else {
            return;
        };
        // Enough said where the value depends on something that failed.
        let message = format!(
            "`{name}` of `{}` expects {wanted}, but this is {}",
            self.word,
            value.noun()
        );
        let error = Diagnostic::error(span, message).label(value.shown());
        self.note(machine, error.help_if(help.map(String::from)));
    }

    fn out_of_range(
        &mut self,
        machine: &mut Machine<'a>,
        name: &str,
        words: &str,
        value: &Value,
        default: Option<String>,
    ) {
        let message = format!("`{name}` of `{}` must be {words}", self.word);
        let error = Diagnostic::error(self.place(name), message).label(value.shown());
        let help = default.map(|default| format!("the default is {default}"));
        self.note(machine, error.help_if(help));
    }

    /// A finite number within a range.
    pub fn number(
        &mut self,
        machine: &mut Machine<'a>,
        name: &str,
        range: (&str, impl Fn(f64) -> bool),
        default: f64,
    ) -> f64 {
        match self.get(name) {
            None => default,
            Some((Value::Number(x), _)) if range.1(x) && x.is_finite() => x,
            Some((value @ Value::Number(_), _)) => {
                let shown = Some(crate::catalogue::written(default));
                self.out_of_range(machine, name, range.0, &value, shown);
                default
            }
            Some(_) => {
                self.wrong_kind(machine, name, "a number", None);
                default
            }
        }
    }

    /// An angle within a range, in radians.
    pub fn angle(
        &mut self,
        machine: &mut Machine<'a>,
        name: &str,
        range: (&str, impl Fn(f64) -> bool),
        default: f64,
    ) -> f64 {
        match self.get(name) {
            None => default,
            Some((Value::Angle(x), _)) if range.1(x) => x,
            Some((value @ Value::Angle(_), _)) => {
                let shown = Some(Value::Angle(default).to_string());
                self.out_of_range(machine, name, range.0, &value, shown);
                default
            }
            Some(_) => {
                let help = "angles carry a unit, as in `45deg`";
                self.wrong_kind(machine, name, "an angle", Some(help));
                default
            }
        }
    }

    /// A point or direction with finite components.
    pub fn vector(&mut self, machine: &mut Machine<'a>, name: &str, default: DVec3) -> DVec3 {
        match self.get(name) {
            None => default,
            Some((Value::Vector3(v), _)) if v.iter().all(|c| c.is_finite()) => DVec3::from(v),
            Some((value @ Value::Vector3(_), _)) => {
                self.out_of_range(machine, name, "finite", &value, None);
                default
            }
            Some(_) => {
                self.wrong_kind(machine, name, "a vector [x, y, z]", None);
                default
            }
        }
    }

    /// Two numbers within a range.
    pub fn pair(
        &mut self,
        machine: &mut Machine<'a>,
        name: &str,
        range: (&str, impl Fn(f64) -> bool),
    ) -> Option<[f64; 2]> {
        match self.get(name)? {
            (Value::Vector2(v), _) if v.iter().all(|c| range.1(*c)) => Some(v),
            (value @ Value::Vector2(_), _) => {
                self.out_of_range(machine, name, range.0, &value, None);
                None
            }
            _ => {
                self.wrong_kind(machine, name, "two numbers [a, b]", None);
                None
            }
        }
    }

    /// A colour whose parts are not negative.
    pub fn color(&mut self, machine: &mut Machine<'a>, name: &str, default: DVec3) -> DVec3 {
        match self.get(name) {
            None => default,
            Some((Value::Color(c), _)) if is_color(&c) => DVec3::from(c),
            Some((value @ Value::Color(_), _)) => {
                self.out_of_range(machine, name, "zero or positive", &value, None);
                default
            }
            Some(_) => {
                let help = "colours are written `#d9a441` or `rgb(r, g, b)`";
                self.wrong_kind(machine, name, "a colour", Some(help));
                default
            }
        }
    }

    /// One of some words.
    pub fn choice<T: Copy>(
        &mut self,
        machine: &mut Machine<'a>,
        name: &str,
        choices: &[(&'static str, T)],
        default: T,
    ) -> T {
        let words = choices.iter().map(|(word, _)| *word);
        match self.get(name) {
            None => default,
            Some((Value::Text(text), span)) => {
                if let Some((_, choice)) = choices.iter().find(|(word, _)| **word == *text) {
                    return *choice;
                }
                let message = format!(
                    "`{name}` of `{}` knows no \"{}\"",
                    self.word,
                    clipped(&text)
                );
                let help = match super::hint::nearest(&text, words.clone()) {
                    Some(word) => format!("did you mean \"{word}\"?"),
                    None => {
                        let all: Vec<String> = words.map(|word| format!("\"{word}\"")).collect();
                        format!("it is {}", joined(&all, "or"))
                    }
                };
                let error = Diagnostic::error(span, message).help(help);
                self.note(machine, error);
                default
            }
            Some(_) => {
                let all: Vec<String> = words.map(|word| format!("\"{word}\"")).collect();
                self.wrong_kind(machine, name, &joined(&all, "or"), None);
                default
            }
        }
    }

    /// A truth value.
    pub fn truth(&mut self, machine: &mut Machine<'a>, name: &str, default: bool) -> bool {
        match self.get(name) {
            None => default,
            Some((Value::Bool(x), _)) => x,
            Some(_) => {
                self.wrong_kind(machine, name, "true or false", None);
                default
            }
        }
    }
}

/// Whether all parts are finite and not negative.
pub(super) fn is_color(c: &[f64; 3]) -> bool {
    c.iter().all(|part| part.is_finite() && *part >= 0.0)
}
