//! What the parser expected, in words: pest's findings brought down to a few categories.

use super::hint::{clipped, joined, nearest};
use super::report::Diagnostic;
use super::source::Span;
use super::syntax::{Rule, STATEMENT_WORDS};
use pest::error::{Error, ErrorVariant, InputLocation};

/// Where the error is, in bytes from the start of what was parsed.
pub(super) fn place(error: &Error<Rule>) -> usize {
    match error.location {
        InputLocation::Pos(at) => at,
        InputLocation::Span((start, _)) => start,
    }
}

/// How many bytes of blanks and comments the text starts with.
pub(super) fn blank_length(text: &str) -> usize {
    let mut rest = text;
    loop {
        let before = rest.len();
        rest = rest.trim_start_matches([' ', '\t', '\r', '\n', '\u{feff}']);
        if rest.starts_with("//") {
            rest = rest.find('\n').map_or("", |i| &rest[i..]);
        } else if rest.starts_with("/*") {
            rest = after_comment(rest);
        }
        if rest.len() == before {
            return text.len() - rest.len();
        }
    }
}

fn after_comment(text: &str) -> &str {
    let bytes = text.as_bytes();
    let (mut depth, mut at) = (0usize, 0);
    while at + 1 < bytes.len() {
        match &bytes[at..at + 2] {
            b"/*" => (depth, at) = (depth + 1, at + 2),
            b"*/" => (depth, at) = (depth.saturating_sub(1), at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            return &text[at..];
        }
    }
    ""
}

/// The diagnostic for an error in the statement that starts at byte `at` of `text`.
pub(super) fn diagnose(error: &Error<Rule>, file: u32, text: &str, at: usize) -> Diagnostic {
    let place = at + place(error);
    let found = token(&text[place..]);
    let span = if found.is_empty() {
        end_of_text(file, text)
    } else {
        Span {
            file,
            start: place as u32,
            end: (place + found.len()) as u32,
        }
    };
    let positives = match &error.variant {
        ErrorVariant::ParsingError { positives, .. } => positives.as_slice(),
        ErrorVariant::CustomError { message } => {
            return Diagnostic::error(span, format!("the script is too deep to parse: {message}"));
        }
    };
    let found_words = match found {
        "" => "the end of the script".into(),
        _ => format!("`{}`", clipped(found)),
    };
    let expected = categories(positives);
    let mut diagnostic = if expected.is_empty() || positives.contains(&Rule::EOI) {
        statement_wanted(span, text, place, found, &found_words)
    } else {
        let expected = joined(&expected, "or");
        Diagnostic::error(span, format!("expected {expected}, found {found_words}"))
    };
    if let Some(help) = remedy(found, positives) {
        diagnostic = diagnostic.help(help);
    }
    diagnostic
}

/// The span of the last byte that says something.
fn end_of_text(file: u32, text: &str) -> Span {
    let end = text.trim_end().len();
    let start = text[..end].char_indices().next_back().map_or(0, |(i, _)| i);
    Span {
        file,
        start: start as u32,
        end: end as u32,
    }
}

/// The first token of the text, as a reader would see it; empty at its end.
fn token(text: &str) -> &str {
    let Some(first) = text.chars().next() else {
        return "";
    };
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    if is_part(first) {
        let end = text.find(|c| !is_part(c)).unwrap_or(text.len());
        return &text[..end];
    }
    let long = [
        "..=", "..", "==", "!=", "<=", ">=", "||", "&&", "**", "->", "=>", "+=", "-=", "++",
    ];
    long.iter()
        .find(|mark| text.starts_with(**mark))
        .map_or(&text[..first.len_utf8()], |mark| &text[..mark.len()])
}

/// What was expected, each category once, the likeliest first.
fn categories(positives: &[Rule]) -> Vec<String> {
    let mut named: Vec<&str> = Vec::new();
    let mut add = |words| {
        if !named.contains(&words) {
            named.push(words);
        }
    };
    // Where an index could follow, so could a call.
    let is_after_operand =
        positives.contains(&Rule::open_bracket) || positives.contains(&Rule::index);
    for rule in positives {
        if *rule == Rule::open_paren && is_after_operand {
            continue;
        }
        if let Some(words) = category(*rule) {
            add(words);
        }
    }
    // Inside a bracket an operator could always follow: that says little.
    let is_specific = named.iter().any(|words| *words != OPERATOR);
    if is_specific {
        named.retain(|words| *words != OPERATOR);
    }
    // Where a whole expression may stand, its brackets and words need no mention.
    if named.contains(&EXPRESSION) {
        named.retain(|words| !["`(`", "`[`", "`if`", "`for`", "`not`"].contains(words));
        named.sort_by_key(|words| *words != EXPRESSION);
    }
    named.into_iter().map(String::from).collect()
}

const OPERATOR: &str = "an operator";
const EXPRESSION: &str = "an expression";

fn category(rule: Rule) -> Option<&'static str> {
    use Rule::*;
    Some(match rule {
        expression | chain | operand | primary | prefix | bad_number | quantity | number
        | color | true_word | false_word | conditional | r#loop | list | group | negate
        | not_word | argument => EXPRESSION,
        if_word => "`if`",
        for_word => "`for`",
        string | quote | characters => "a string",
        name | formal => "a name",
        word | entry => "a name",
        label => return None,
        or_word | and_word | less_equal | greater_equal | less | greater | equal | not_equal
        | unite | intersect | add | subtract | multiply | divide | remainder | power | infix
        | arguments | index | member | dot | range_mark | step_word => OPERATOR,
        open_paren | signature => "`(`",
        close_paren => "`)`",
        open_bracket => OPERATOR,
        close_bracket => "`]`",
        open_brace | block | entries => "`{`",
        close_brace => "`}`",
        comma => "`,`",
        colon => "`:`",
        equals => "`=`",
        as_word => "`as`",
        in_word => "`in`",
        else_word => "`else`",
        return_word => "`return`",
        local | let_word => "`let`",
        expect | expect_word => "`expect`",
        claim | lipschitz_word => "`lipschitz`",
        _ => return None,
    })
}

/// Something stands where a statement should start, or where the one before should go on.
fn statement_wanted(
    span: Span,
    text: &str,
    place: usize,
    found: &str,
    found_words: &str,
) -> Diagnostic {
    let line = text[..place].rfind('\n').map_or(0, |i| i + 1);
    let is_first = text[line..place].trim().is_empty();
    let is_word = found.starts_with(|c: char| c.is_alphabetic() || c == '_');
    let after = text[place + found.len()..].trim_start();
    if !is_first {
        let error = Diagnostic::error(
            span,
            format!("expected an operator or a new statement, found {found_words}"),
        );
        let is_operand = is_word || found.starts_with(|c: char| c.is_ascii_digit());
        return match is_operand {
            true => error.help("a call needs parentheses: `f(x)`"),
            false => error,
        };
    }
    if !is_word {
        return Diagnostic::error(span, format!("expected a statement, found {found_words}"))
            .help("a statement starts with a word, as in `show sphere(1)`");
    }
    let error = Diagnostic::error(span, format!("unknown statement {found_words}"));
    if after.starts_with('=') && !after.starts_with("==") {
        return error.help(format!("names are given once, with `let {found} = ...`"));
    }
    if ["for", "if"].contains(&found) {
        return error.help(format!(
            "`{found}` is an expression: `let` names what it gives, `show` shows it"
        ));
    }
    match nearest(found, STATEMENT_WORDS) {
        Some(word) => error.help(format!("did you mean `{word}`?")),
        None => error.help("a statement starts with a word, as in `show sphere(1)`"),
    }
}

/// What to write instead of a token from another language.
fn remedy(found: &str, positives: &[Rule]) -> Option<String> {
    let is_name_wanted = positives.contains(&Rule::name) && !positives.contains(&Rule::quantity);
    let is_expression = |rule: &Rule| category(*rule) == Some(EXPRESSION);
    let is_expression_wanted = positives.iter().any(is_expression);
    if positives.contains(&Rule::else_word) {
        return Some(
            "an `if` gives a value, so it needs both: `if condition { a } else { b }`".into(),
        );
    }
    let text = match found {
        "||" => "write `or`, or a single `|` for a union",
        "&&" => "write `and`, or a single `&` for an intersection",
        "!" => "write `not`",
        "**" => "write `^` for a power",
        ";" => "statements need no `;`",
        "'" => "strings stand in double quotes",
        "?" => "write `if condition { a } else { b }`",
        "->" | "=>" => "a function is `fn name(arguments) { expression }`",
        "+=" | "-=" | "++" => "a name is given its value once, with `let`",
        "=" if !positives.contains(&Rule::equals) && !is_name_wanted => {
            "write `==` to compare, `:` to name an argument"
        }
        "else" => "write `if condition { a } else { b }`",
        "{" if is_expression_wanted => {
            "braces hold the terms of a statement, which has a name: `material tin { reflect: 0.5 }`, then `.paint(tin)`"
        }
        "return" | "let" if positives.contains(&Rule::close_brace) => {
            "a block is one expression, or `let`s followed by `return` and an expression"
        }
        word if is_name_wanted && is_reserved(word) => {
            return Some(format!("`{word}` is a reserved word"));
        }
        _ => return None,
    };
    Some(text.into())
}

fn is_reserved(word: &str) -> bool {
    const RESERVED: [&str; 18] = [
        "import", "as", "param", "let", "fn", "field", "pattern", "return", "for", "in", "if",
        "else", "and", "or", "not", "true", "false", "show",
    ];
    RESERVED.contains(&word)
}
