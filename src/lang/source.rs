//! Source texts, and places in them.

use crate::scene::Mark;
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
    /// The span as a mark on the operations of a graph: 16 bits for the text, 24 for the start and 24 for the length.
    pub fn mark(self) -> Mark {
        let (file, start, end) = (self.file.into(), self.start.into(), u64::from(self.end));
        let field = |x: u64, bits: u32| x & ((1 << bits) - 1);
        Mark(field(file, 16) << 48 | field(start, 24) << 24 | field(end - start, 24))
    }

    /// The span that a mark was made from.
    pub fn marked(Mark(bits): Mark) -> Self {
        let (file, start, length) = (bits >> 48, bits >> 24 & 0xff_ffff, bits & 0xff_ffff);
        Self {
            file: file as u32,
            start: start as u32,
            end: (start + length) as u32,
        }
    }

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
    /// Where its lines start.
    lines: Arc<[u32]>,
}

/// The texts that diagnostics point into.
#[derive(Clone, Debug, Default)]
pub struct Sources(Vec<Source>);

impl Sources {
    /// Adds a text and gives its number.
    pub fn add(&mut self, name: &str, text: &str) -> u32 {
        let ends = text.bytes().enumerate().filter(|(_, b)| *b == b'\n');
        let starts = ends.map(|(i, _)| i as u32 + 1);
        self.0.push(Source {
            name: name.into(),
            text: text.into(),
            lines: std::iter::once(0).chain(starts).collect(),
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

    /// The line of the first byte of `span`, from 1.
    pub fn line(&self, span: Span) -> usize {
        let lines = &self.get(span.file).lines;
        lines.partition_point(|start| *start <= span.start)
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
