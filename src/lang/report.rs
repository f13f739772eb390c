//! Reports: what is wrong with a script, drawn with its source lines.

use super::limits::MAX_SHOWN;
use super::source::{Sources, Span};
use annotate_snippets::{Annotation, AnnotationKind, Group, Level as Drawn, Renderer, Snippet};
use std::collections::HashSet;
use std::fmt;

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// The script cannot be used.
    Error,
    /// The script can be used, but probably does not say what was meant.
    Warning,
}

/// One thing that is wrong with a script.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// How bad it is.
    pub level: Level,
    /// What is wrong.
    pub message: String,
    /// Where; none for what concerns the script as a whole.
    pub span: Option<Span>,
    /// What stands at the span; may be empty.
    pub label: String,
    /// What to write instead.
    pub help: Option<String>,
    /// Other places that matter: where a bracket was opened, or the calls that led here, the innermost first.
    pub notes: Vec<(Span, String)>,
}

impl Diagnostic {
    /// An error at `span`.
    pub fn error(span: Span, message: impl Into<String>) -> Self {
        Self {
            level: Level::Error,
            message: message.into(),
            span: Some(span),
            label: String::new(),
            help: None,
            notes: Vec::new(),
        }
    }

    /// A warning at `span`.
    pub fn warning(span: Span, message: impl Into<String>) -> Self {
        Self {
            level: Level::Warning,
            ..Self::error(span, message)
        }
    }

    /// The same, with a word on what stands at the span.
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// The same, with a hint what to write instead.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// The same, with a hint if there is one.
    pub fn help_if(mut self, help: Option<String>) -> Self {
        self.help = help.or(self.help);
        self
    }

    /// The same, with another place that matters.
    pub fn note(mut self, span: Span, text: impl Into<String>) -> Self {
        self.notes.push((span, text.into()));
        self
    }
}

/// Everything that is wrong with a script, in the order of its text.
#[derive(Clone, Debug, Default)]
pub struct Report {
    diagnostics: Vec<Diagnostic>,
    sources: Sources,
}

impl Report {
    /// The report of these diagnostics: sorted by place, each said once.
    pub fn new(mut diagnostics: Vec<Diagnostic>, sources: Sources) -> Self {
        let key = |d: &Diagnostic| d.span.map_or((u32::MAX, 0), |s| (s.file, s.start));
        diagnostics.sort_by_key(key);
        let mut said = HashSet::new();
        diagnostics.retain(|d| said.insert((d.span, d.message.clone())));
        Self {
            diagnostics,
            sources,
        }
    }

    /// How many errors and warnings there are.
    pub fn len(&self) -> usize {
        self.diagnostics.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.diagnostics.is_empty()
    }

    /// Whether any of them is an error.
    pub fn has_errors(&self) -> bool {
        self.iter().any(|d| d.level == Level::Error)
    }

    /// All of them, in order.
    pub fn iter(&self) -> impl Iterator<Item = &Diagnostic> {
        self.diagnostics.iter()
    }

    /// The texts that the diagnostics point into.
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    /// The report as text, with terminal colours if wanted.
    pub fn render(&self, color: bool) -> String {
        let renderer = if color {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        let renderer = renderer.term_width(120);
        let mut text = String::new();
        for diagnostic in self.diagnostics.iter().take(MAX_SHOWN) {
            text.push_str(&renderer.render(&[self.drawn(diagnostic)]));
            text.push_str("\n\n");
        }
        if self.len() > MAX_SHOWN {
            text.push_str(&format!("... and {} more\n\n", self.len() - MAX_SHOWN));
        }
        text
    }

    /// The diagnostic as annotate-snippets takes it: one snippet for each file, the place of the error first.
    fn drawn<'a>(&'a self, diagnostic: &'a Diagnostic) -> Group<'a> {
        let level = match diagnostic.level {
            Level::Error => Drawn::ERROR,
            Level::Warning => Drawn::WARNING,
        };
        let mut group = Group::with_title(level.primary_title(&diagnostic.message));
        let first = diagnostic
            .span
            .map(|span| (span, diagnostic.label.as_str(), AnnotationKind::Primary));
        let others = diagnostic
            .notes
            .iter()
            .map(|(span, text)| (*span, text.as_str(), AnnotationKind::Context));
        let mut left: Vec<_> = first.into_iter().chain(others).collect();
        while let Some((span, ..)) = left.first() {
            let file = span.file;
            let (here, elsewhere) = left.into_iter().partition(|(s, ..)| s.file == file);
            group = group.element(self.snippet(file, here));
            left = elsewhere;
        }
        if let Some(help) = &diagnostic.help {
            group = group.element(Drawn::HELP.message(help));
        }
        group
    }

    /// The lines of one file that hold the spans, each span cut to its first line.
    fn snippet<'a>(
        &'a self,
        file: u32,
        spans: Vec<(Span, &'a str, AnnotationKind)>,
    ) -> Snippet<'a, Annotation<'a>> {
        let source = self.sources.get(file);
        let text: &str = &source.text;
        let line_start = |at: usize| text[..at].rfind('\n').map_or(0, |i| i + 1);
        let line_end = |at: usize| {
            let end = text[at..].find('\n').map_or(text.len(), |i| at + i);
            at + text[at..end].trim_end_matches('\r').len()
        };
        let starts = || spans.iter().map(|(span, ..)| span.start as usize);
        let from = line_start(starts().min().unwrap_or(0));
        let to = line_end(starts().max().unwrap_or(0));
        let number = text[..from].bytes().filter(|b| *b == b'\n').count() + 1;
        // A line end of two bytes would be drawn; in place of the first a blank does no harm.
        let lines = text[from..to].replace("\r\n", " \n");
        let mut snippet = Snippet::source(lines)
            .line_start(number)
            .path(&*source.name);
        for (span, label, kind) in spans {
            let (start, end) = (span.start as usize, span.end as usize);
            let end = end.min(line_end(start)).max(start);
            let annotation = kind.span(start - from..end - from);
            snippet = snippet.annotation(if label.is_empty() {
                annotation
            } else {
                annotation.label(label)
            });
        }
        snippet
    }
}

/// As plain text, without colours.
impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Report {}
