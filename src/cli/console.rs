//! The terminal: answers go to standard output, everything else to standard error. Neither ever panics.

use super::failure::Failure;
use std::io::{self, IsTerminal, Write};

/// What standard output is called in messages.
const OUTPUT: &str = "standard output";

/// Writes the whole answer of a command.
///
/// # Errors
/// If standard output cannot take it; [`Failure::Closed`] if nobody reads it.
pub fn answer(text: &str) -> Result<(), Failure> {
    answer_bytes(text.as_bytes())
}

/// Writes the whole answer of a command, as bytes.
///
/// # Errors
/// As [`answer`].
pub fn answer_bytes(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    out.write_all(bytes)
        .and_then(|()| out.flush())
        .map_err(|error| Failure::writing(OUTPUT, &error))
}

/// Says something to the user. Nobody is told where that is impossible.
pub fn say(text: &str) {
    let mut err = io::stderr().lock();
    let _ = err.write_all(text.as_bytes());
    let _ = err.flush();
}

/// Says a line to the user.
pub fn say_line(line: &str) {
    say(&format!("{line}\n"));
}

/// Says what failed.
pub fn say_error(message: &str) {
    say_line(&format!(
        "{}: {message}",
        colored("error", RED, speaks_color())
    ));
}

/// Says what is to be looked at.
pub fn say_warning(message: &str) {
    say_line(&format!(
        "{}: {message}",
        colored("warning", YELLOW, speaks_color())
    ));
}

/// The terminal's code for bold red.
pub const RED: &str = "1;31";

/// The terminal's code for bold green.
pub const GREEN: &str = "1;32";

/// The terminal's code for bold yellow.
pub const YELLOW: &str = "1;33";

/// The text in a colour, if colours are wanted.
pub fn colored(text: &str, code: &str, is_wanted: bool) -> String {
    if is_wanted {
        format!("\x1b[{code}m{text}\x1b[0m")
    } else {
        text.into()
    }
}

/// Whether what is said may be coloured.
pub fn speaks_color() -> bool {
    io::stderr().is_terminal() && allows_color(|name| std::env::var(name).ok())
}

/// Whether the answer may be coloured.
pub fn answers_color() -> bool {
    io::stdout().is_terminal() && allows_color(|name| std::env::var(name).ok())
}

/// Whether the environment leaves colours on: no `NO_COLOR` (any value but an empty one) and a terminal that has them.
fn allows_color(variable: impl Fn(&str) -> Option<String>) -> bool {
    let is_refused = variable("NO_COLOR").is_some_and(|value| !value.is_empty());
    let is_dumb = variable("TERM").is_none_or(|term| term == "dumb");
    !is_refused && !is_dumb
}

/// The number with its noun: `1 scene`, `2 scenes`.
pub fn counted(n: usize, noun: &str) -> String {
    let plural = if n == 1 { "" } else { "s" };
    format!("{n} {noun}{plural}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_color_and_dumb_terminals_get_no_color() {
        let with = |no_color: Option<&str>, term: Option<&str>| {
            allows_color(|name| {
                let value = if name == "TERM" { term } else { no_color };
                value.map(String::from)
            })
        };
        assert!(with(None, Some("xterm")));
        assert!(with(Some(""), Some("xterm")));
        assert!(!with(Some("1"), Some("xterm")));
        assert!(!with(None, Some("dumb")));
        assert!(!with(None, None));
    }

    #[test]
    fn one_has_no_plural() {
        assert_eq!(counted(1, "scene"), "1 scene");
        assert_eq!(counted(0, "scene"), "0 scenes");
    }
}
