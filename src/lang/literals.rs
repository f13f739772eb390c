//! Literals: numbers with units, colours, strings.

use super::ast::Literal;
use super::build::{Builder, Inner};
use super::color::color_of_hex;
use super::hint::{clipped, nearest};
use super::limits::MAX_STRING;
use super::report::Diagnostic;
use super::source::Word;
use super::syntax::Rule;
use pest::iterators::Pair;

impl Builder {
    pub fn quantity(&mut self, pair: Pair<'_, Rule>) -> Literal {
        let span = self.span(&pair);
        let mut inner = Inner::of(pair);
        let number = inner.take();
        let text = number.as_str();
        let value: f64 = text.parse().expect("the grammar reads only numbers");
        if !value.is_finite() {
            let error = Diagnostic::error(span, "this number is too large")
                .help("the largest is about 1.8e308");
            self.diagnostics.push(error);
            return Literal::Number(0.0);
        }
        let Some(unit) = inner.take_if(Rule::unit) else {
            return Literal::Number(value);
        };
        match unit.as_str() {
            "deg" => Literal::Angle(value.to_radians()),
            "turn" => Literal::Angle(value * std::f64::consts::TAU),
            "rad" => Literal::Angle(value),
            other => {
                let units = ["deg", "turn", "rad"];
                let help = match nearest(other, units) {
                    Some(unit) => format!("did you mean `{unit}`?"),
                    None => "angles are written `45deg`, `0.25turn` or `1.2rad`; lengths have no \
                             unit; a product needs `*`"
                        .into(),
                };
                let message = format!("unknown unit `{}`", clipped(other));
                let error = Diagnostic::error(self.span(&unit), message).help(help);
                self.diagnostics.push(error);
                Literal::Number(value)
            }
        }
    }

    pub fn bad_number(&mut self, pair: &Pair<'_, Rule>) -> Literal {
        let text = pair.as_str();
        let (message, better) = if text.starts_with('.') {
            ("a digit must stand before the point", format!("0{text}"))
        } else {
            ("a digit must follow the point", format!("{text}0"))
        };
        let error = Diagnostic::error(self.span(pair), message)
            .help(format!("write `{}`", clipped(&better)));
        self.diagnostics.push(error);
        Literal::Number(0.0)
    }

    pub fn color(&mut self, pair: &Pair<'_, Rule>) -> Literal {
        if let Some(color) = color_of_hex(&pair.as_str()[1..]) {
            return Literal::Color(color);
        }
        let error = Diagnostic::error(self.span(pair), "this is no colour")
            .help("a colour has three or six hexadecimal digits: `#fc8` or `#ffcc88`");
        self.diagnostics.push(error);
        Literal::Color([0.0; 3])
    }

    /// The text of a string, with the span of the whole literal.
    pub fn string_word(&mut self, pair: Pair<'_, Rule>) -> Word {
        let span = self.span(&pair);
        let raw = Inner::of(pair).find(Rule::characters);
        if raw.as_str().len() > MAX_STRING {
            let message =
                format!("this string is longer than {MAX_STRING} bytes (limit MAX_STRING)");
            self.diagnostics.push(Diagnostic::error(span, message));
        }
        let mut text = String::with_capacity(raw.as_str().len());
        let mut characters = raw.as_str().chars();
        while let Some(c) = characters.next() {
            let escaped = if c == '\\' { characters.next() } else { None };
            text.push(match escaped {
                None => c,
                Some('n') => '\n',
                Some('t') => '\t',
                Some(c @ ('"' | '\\')) => c,
                Some(other) => {
                    let error = Diagnostic::error(span, format!("unknown escape `\\{other}`"))
                        .help("strings know `\\n`, `\\t`, `\\\"` and `\\\\`");
                    self.diagnostics.push(error);
                    other
                }
            });
        }
        Word {
            text: text.into(),
            span,
        }
    }
}
