//! Source texts, and places in them.

use std::sync::Arc;

/// A part of a source text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span {
    /// The number of the text in its [`Sources`]; 0 is the script itself.
    pub file: u32,
    /// The first byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Span {
    /// From the start of `self` to the end of `other`, in the same text.
    pub fn to(self, other: Self) -> Self {
        Self {
            end: other.end,
            ..self
        }
    }
}

/// A text with the name that messages give it.
#[derive(Clone, Debug)]
pub struct Source {
    /// The path as the user named it.
    pub name: Arc<str>,
    /// The whole text.
    pub text: Arc<str>,
}

/// The texts that diagnostics point into.
#[derive(Clone, Debug, Default)]
pub struct Sources(Vec<Source>);

impl Sources {
    /// Adds a text and gives its number.
    pub fn add(&mut self, name: &str, text: &str) -> u32 {
        self.0.push(Source {
            name: name.into(),
            text: text.into(),
        });
        (self.0.len() - 1) as u32
    }

    /// The text number `file`.
    pub fn get(&self, file: u32) -> &Source {
        &self.0[file as usize]
    }

    /// The bytes of all texts together.
    pub fn bytes(&self) -> usize {
        self.0.iter().map(|source| source.text.len()).sum()
    }

    /// What stands at `span`.
    pub fn text(&self, span: Span) -> &str {
        self.get(span.file)
            .text
            .get(span.start as usize..span.end as usize)
            .unwrap_or("")
    }

    /// Line and column of the first byte of `span`, both from 1; columns count characters.
    pub fn line_column(&self, span: Span) -> (usize, usize) {
        let before = &self.get(span.file).text[..span.start as usize];
        let line = before.bytes().filter(|b| *b == b'\n').count() + 1;
        let in_line = before.rfind('\n').map_or(0, |i| i + 1);
        (line, before[in_line..].chars().count() + 1)
    }
}

/// A name as it stands in a script.
#[derive(Clone, Debug)]
pub struct Word {
    /// The name.
    pub text: Arc<str>,
    /// Where it stands.
    pub span: Span,
}
