//! The parser: reads one statement after another with pest and goes on after an error.

use super::ast::{Statement, StatementKind};
use super::build::Builder;
use super::complaint;
use super::hint::clipped;
use super::limits::{MAX_PARSE_ERRORS, MAX_SCRIPT_BYTES, MAX_STATEMENT_BYTES};
use super::report::Diagnostic;
use super::scan::scan;
use super::source::{Span, Word};
use pest::Parser;
use pest::iterators::Pair;
use std::num::NonZeroUsize;
use std::sync::Once;

#[derive(pest_derive::Parser)]
#[grammar = "../grammar/fieldstone.pest"]
pub(super) struct Grammar;

/// The words that start a statement.
pub(super) const STATEMENT_WORDS: [&str; 15] = [
    "import", "param", "let", "fn", "field", "pattern", "material", "show", "camera", "light",
    "sky", "fog", "render", "budget", "test",
];

/// What a text says, as far as it could be read.
#[derive(Debug, Default)]
pub(super) struct Parsed {
    pub statements: Vec<Statement>,
    pub diagnostics: Vec<Diagnostic>,
}

/// Reads the text of file number `file`.
pub(super) fn parse(file: u32, text: &str) -> Parsed {
    limit_calls();
    let scan = scan(file, text);
    let mut parsed = Parsed {
        statements: Vec::new(),
        diagnostics: scan.diagnostics,
    };
    if scan.is_fatal {
        return parsed;
    }
    let mut at = 0;
    while at < text.len() && parsed.diagnostics.len() < MAX_PARSE_ERRORS {
        at += complaint::blank_length(&text[at..]);
        let rest = statement_text(&text[at..]);
        let error = match Grammar::parse(Rule::next, rest) {
            Ok(mut pairs) => {
                let Some((statement, length)) = pairs.next().and_then(first_statement) else {
                    if rest.len() == text.len() - at {
                        break;
                    }
                    parsed.diagnostics.push(too_long(file, at));
                    break;
                };
                if length == rest.len() && rest.len() < text.len() - at {
                    parsed.diagnostics.push(too_long(file, at));
                    break;
                }
                let mut builder = Builder::new(file, at as u32);
                let built = builder.statement(statement);
                // Where a literal is wrong, what follows from it would only repeat that.
                let is_good = builder.diagnostics.is_empty();
                let place = at + length;
                let bad = || broken(file, text, at, place);
                parsed.statements.push(if is_good { built } else { bad() });
                parsed.diagnostics.append(&mut builder.diagnostics);
                at += length;
                continue;
            }
            Err(error) => error,
        };
        if rest.len() < text.len() - at && complaint::place(&error) >= rest.len() {
            parsed.diagnostics.push(too_long(file, at));
            break;
        }
        let place = at + complaint::place(&error);
        // What the scan has found already is not said twice.
        let is_known = scan.unpaired.is_some_and(|unpaired| unpaired <= place);
        if !is_known {
            parsed
                .diagnostics
                .push(complaint::diagnose(&error, file, text, at));
        }
        if continues(&parsed.statements, text, at) {
            spoil(&mut parsed.statements, file, text);
        }
        parsed.statements.push(broken(file, text, at, place));
        at = resume(text, at, place);
    }
    parsed
}

/// Whether what could not be read stands on the line on which the statement before it ended: then it was meant to belong
/// to it.
fn continues(statements: &[Statement], text: &str, at: usize) -> bool {
    let line = text[..at].rfind('\n').map_or(0, |i| i + 1);
    let is_there = |last: &Statement| last.span.end as usize > line;
    statements.last().is_some_and(is_there)
}

/// Takes the last statement back, but for the name that it defines.
fn spoil(statements: &mut Vec<Statement>, file: u32, text: &str) {
    if let Some(last) = statements.pop() {
        let (start, end) = (last.span.start as usize, last.span.end as usize);
        statements.push(broken(file, text, start, end));
    }
}

/// Reads an expression that stands alone, as on the command line.
pub(super) fn parse_expression(
    file: u32,
    text: &str,
    from: usize,
) -> Result<super::ast::Expression, Vec<Diagnostic>> {
    limit_calls();
    let scan = scan(file, text);
    if !scan.diagnostics.is_empty() {
        return Err(scan.diagnostics);
    }
    let pair = match Grammar::parse(Rule::expression, &text[from..]) {
        Ok(mut pairs) => pairs.next(),
        Err(error) => return Err(vec![complaint::diagnose(&error, file, text, from)]),
    };
    let whole = pair.filter(|pair| from + pair.as_span().end() == text.trim_end().len());
    let Some(pair) = whole else {
        let span = span(file, from, text.len());
        let error = Diagnostic::error(span, "expected one value").help("as in `-D teeth=30`");
        return Err(vec![error]);
    };
    let mut builder = Builder::new(file, from as u32);
    let expression = builder.expression(pair);
    if builder.diagnostics.is_empty() {
        Ok(expression)
    } else {
        Err(builder.diagnostics)
    }
}

/// Belt and braces: the grammar needs about 14 calls a byte, so no statement within its limit meets this.
fn limit_calls() {
    static LIMIT: Once = Once::new();
    LIMIT.call_once(|| {
        pest::set_call_limit(NonZeroUsize::new(1_000_000 + 200 * MAX_SCRIPT_BYTES));
    });
}

/// As much of the text as one statement may have.
fn statement_text(rest: &str) -> &str {
    if rest.len() <= MAX_STATEMENT_BYTES {
        return rest;
    }
    &rest[..rest.floor_char_boundary(MAX_STATEMENT_BYTES)]
}

/// The statement in a match of `next`, and where it ends; none at the end of the text.
fn first_statement(next: Pair<'_, Rule>) -> Option<(Pair<'_, Rule>, usize)> {
    let statement = next.into_inner().find(|pair| pair.as_rule() != Rule::EOI)?;
    let end = statement.as_span().end();
    Some((statement, end))
}

fn span(file: u32, start: usize, end: usize) -> Span {
    Span {
        file,
        start: start as u32,
        end: end as u32,
    }
}

fn too_long(file: u32, at: usize) -> Diagnostic {
    let message = format!(
        "a statement is longer than {MAX_STATEMENT_BYTES} bytes (limit MAX_STATEMENT_BYTES)"
    );
    Diagnostic::error(span(file, at, at + 1), message)
        .label("it starts here")
        .help("cut it into several statements")
}

/// What is left of a statement that could not be read: the name that it was about to define.
fn broken(file: u32, text: &str, at: usize, place: usize) -> Statement {
    let start = at + complaint::blank_length(&text[at..]);
    let mut words = text[start..].split_whitespace();
    let defines = ["param", "let", "fn", "field", "pattern", "material"];
    let (first, second) = (words.next(), words.next());
    let name = first
        .filter(|word| defines.contains(word))
        .and(second)
        // In an assignment the name comes first.
        .or(first.filter(|_| second == Some("=")))
        .map(|word| {
            let end = word
                .find(|c: char| !c.is_alphanumeric() && c != '_')
                .unwrap_or(word.len());
            let offset = word.as_ptr() as usize - text.as_ptr() as usize;
            Word {
                text: clipped(&word[..end]).into(),
                span: span(file, offset, offset + end),
            }
        })
        .filter(|word| !word.text.is_empty());
    Statement {
        span: span(file, start, place.max(start)),
        kind: StatementKind::Broken(name),
    }
}

/// Where to go on after an error at `place` in the statement at `at`: the next line that starts with a statement word
/// and is indented no further than the statement.
fn resume(text: &str, at: usize, place: usize) -> usize {
    let start = at + complaint::blank_length(&text[at..]);
    let indent = start - text[..start].rfind('\n').map_or(0, |i| i + 1);
    // The place itself may be the start of the next statement, where something was missing at the end of this one.
    let mut line = text[..place].rfind('\n').map_or(0, |i| i + 1);
    loop {
        let content = text[line..].trim_start_matches([' ', '\t']);
        let begin = text.len() - content.len();
        let is_new = begin > start && begin - line <= indent;
        if is_new && starts_statement(content) {
            return begin;
        }
        match text[line..].find('\n') {
            Some(length) => line += length + 1,
            None => return text.len(),
        }
    }
}

fn starts_statement(line: &str) -> bool {
    let end = line
        .find(|c: char| !c.is_alphanumeric() && c != '_')
        .unwrap_or(line.len());
    STATEMENT_WORDS.contains(&&line[..end])
}
