//! A look at the bytes of a script before it is parsed: brackets, strings and comments that are never closed, nesting
//! that no parser should be asked to follow. Linear in the size of the text.

use super::limits::MAX_NESTING;
use super::report::Diagnostic;
use super::source::Span;

/// What the scan found.
#[derive(Debug, Default)]
pub(super) struct Scan {
    /// What is wrong.
    pub diagnostics: Vec<Diagnostic>,
    /// Whether the text must not be parsed at all.
    pub is_fatal: bool,
    /// Where the first bracket, string or comment stands that does not pair up, if any.
    pub unpaired: Option<usize>,
}

/// Scans the text of file number `file`.
pub(super) fn scan(file: u32, text: &str) -> Scan {
    let mut scanner = Scanner {
        file,
        text,
        at: 0,
        open: Vec::new(),
        scan: Scan::default(),
    };
    scanner.run();
    scanner.scan
}

struct Scanner<'a> {
    file: u32,
    text: &'a str,
    at: usize,
    open: Vec<(u8, usize)>,
    scan: Scan,
}

impl Scanner<'_> {
    fn run(&mut self) {
        let bytes = self.text.as_bytes();
        while let Some(byte) = bytes.get(self.at) {
            let is_going = match (byte, bytes.get(self.at + 1)) {
                (0, _) => self.null(),
                (b'/', Some(b'/')) => self.skip_line(),
                (b'/', Some(b'*')) => self.skip_comment(),
                (b'"', _) => self.skip_string(),
                (b'(' | b'[' | b'{', _) => self.open(*byte),
                (b')' | b']' | b'}', _) => self.close(*byte),
                _ => {
                    self.at += 1;
                    true
                }
            };
            if !is_going {
                return;
            }
        }
        if let Some((byte, at)) = self.open.pop() {
            let error = self.error(at, 1, format!("`{}` is never closed", byte as char));
            let help = format!("add the `{}` that belongs to it", closer(byte) as char);
            self.pairless(at, error.label("opened here").help(help));
        }
    }

    fn error(&self, at: usize, length: usize, message: impl Into<String>) -> Diagnostic {
        let span = Span {
            file: self.file,
            start: at as u32,
            end: (at + length) as u32,
        };
        Diagnostic::error(span, message)
    }

    /// Notes an error after which the text is not parsed.
    fn fatal(&mut self, diagnostic: Diagnostic) -> bool {
        self.scan.diagnostics = vec![diagnostic];
        self.scan.is_fatal = true;
        false
    }

    /// Notes that what stands at `at` has no partner; what follows is not scanned.
    fn pairless(&mut self, at: usize, diagnostic: Diagnostic) -> bool {
        self.scan.diagnostics.push(diagnostic);
        self.scan.unpaired = Some(at);
        false
    }

    fn null(&mut self) -> bool {
        let error = self
            .error(self.at, 1, "the script contains a NUL byte")
            .help("scripts are plain text in UTF-8");
        self.fatal(error)
    }

    fn skip_line(&mut self) -> bool {
        let rest = &self.text.as_bytes()[self.at..];
        match rest.iter().position(|b| *b == b'\n' || *b == 0) {
            Some(length) => self.at += length,
            None => self.at = self.text.len(),
        }
        true
    }

    fn skip_comment(&mut self) -> bool {
        let bytes = self.text.as_bytes();
        let start = self.at;
        let mut depth = 0;
        while self.at < bytes.len() {
            match (bytes[self.at], bytes.get(self.at + 1)) {
                (b'/', Some(b'*')) => {
                    depth += 1;
                    if depth > MAX_NESTING {
                        return self.too_deep("comments", 2);
                    }
                    self.at += 2;
                }
                (b'*', Some(b'/')) => {
                    depth -= 1;
                    self.at += 2;
                    if depth == 0 {
                        return true;
                    }
                }
                (0, _) => return self.null(),
                _ => self.at += 1,
            }
        }
        let error = self
            .error(start, 2, "this comment is never closed")
            .label("opened here")
            .help("comments nest: each `/*` needs its own `*/`");
        self.pairless(start, error)
    }

    fn skip_string(&mut self) -> bool {
        let bytes = self.text.as_bytes();
        let start = self.at;
        self.at += 1;
        loop {
            match bytes.get(self.at) {
                Some(b'"') => {
                    self.at += 1;
                    return true;
                }
                Some(0) => return self.null(),
                Some(b'\\') if bytes.get(self.at + 1).is_some_and(|b| *b != b'\n') => self.at += 2,
                Some(b'\n') | None => break,
                Some(_) => self.at += 1,
            }
        }
        let error = self
            .error(start, 1, "this string is never closed")
            .label("opened here")
            .help("a string ends with `\"` on the same line");
        self.scan.diagnostics.push(error);
        self.scan.unpaired.get_or_insert(start);
        true
    }

    fn open(&mut self, byte: u8) -> bool {
        if self.open.len() == MAX_NESTING {
            return self.too_deep("brackets", 1);
        }
        self.open.push((byte, self.at));
        self.at += 1;
        true
    }

    fn too_deep(&mut self, what: &str, length: usize) -> bool {
        let message =
            format!("{what} are nested deeper than {MAX_NESTING} levels (limit MAX_NESTING)");
        let error = self
            .error(self.at, length, message)
            .label(format!("level {}", MAX_NESTING + 1))
            .help("give inner parts names with `let`, or unite a list: `union(list)`");
        self.fatal(error)
    }

    fn close(&mut self, byte: u8) -> bool {
        let mark = byte as char;
        let Some((opener, at)) = self.open.pop() else {
            let error = self
                .error(self.at, 1, format!("`{mark}` closes nothing"))
                .help("remove it, or add what it should close");
            return self.pairless(self.at, error);
        };
        if closer(opener) == byte {
            self.at += 1;
            return true;
        }
        let opener_mark = opener as char;
        let error = self
            .error(
                self.at,
                1,
                format!("`{mark}` does not close `{opener_mark}`"),
            )
            .label(format!("expected `{}`", closer(opener) as char))
            .note(
                self.error(at, 1, "").span.unwrap_or(Span {
                    file: self.file,
                    start: 0,
                    end: 0,
                }),
                "opened here",
            );
        self.pairless(at, error)
    }
}

fn closer(opener: u8) -> u8 {
    match opener {
        b'(' => b')',
        b'[' => b']',
        _ => b'}',
    }
}
