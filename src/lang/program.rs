//! A script with everything that it imports, read and parsed.

use super::ast::{Expression, Statement, StatementKind};
use super::hint::counted;
use super::limits::{MAX_IMPORT_DEPTH, MAX_SCRIPT_BYTES};
use super::report::Diagnostic;
use super::source::{Sources, Span, Word};
use super::syntax;
use std::collections::HashMap;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// All modules of a script; number 0 is the script itself.
#[derive(Debug, Default)]
pub(super) struct Program {
    pub sources: Sources,
    pub modules: Vec<Module>,
    pub overrides: Vec<Override>,
}

/// One file.
#[derive(Debug, Default)]
pub(super) struct Module {
    pub statements: Vec<Statement>,
    pub globals: Vec<Global>,
    pub names: HashMap<Arc<str>, u32>,
    /// For each statement the global that it defines.
    pub defines: Vec<Option<u32>>,
}

/// A name that a statement defines.
#[derive(Clone, Debug)]
pub(super) struct Global {
    pub name: Word,
    /// The number of its statement.
    pub statement: usize,
}

/// A value for a parameter from the command line.
#[derive(Debug)]
pub(super) struct Override {
    pub name: Word,
    /// The whole value as it was written.
    pub raw: Word,
    pub value: Result<Expression, Vec<Diagnostic>>,
}

/// What became of the bytes of a file.
pub(super) enum Content {
    Text(String),
    /// Not UTF-8 from this byte on; the text has replacement characters.
    Garbled(String, usize),
    /// More bytes than are allowed.
    TooLong(u64),
}

/// The content of the file, of which at most `limit` bytes are read.
pub(super) fn content(path: &Path, limit: usize) -> io::Result<Content> {
    let file = File::open(path)?;
    let length = file.metadata()?.len();
    if length > limit as u64 {
        return Ok(Content::TooLong(length));
    }
    let mut bytes = Vec::new();
    file.take(limit as u64 + 1).read_to_end(&mut bytes)?;
    if bytes.len() > limit {
        return Ok(Content::TooLong(bytes.len() as u64));
    }
    Ok(match String::from_utf8(bytes) {
        Ok(text) => Content::Text(text),
        Err(error) => {
            let good = error.utf8_error().valid_up_to();
            Content::Garbled(String::from_utf8_lossy(error.as_bytes()).into_owned(), good)
        }
    })
}

/// Reads a script and its imports.
#[derive(Default)]
pub(super) struct Reader {
    pub program: Program,
    pub diagnostics: Vec<Diagnostic>,
    /// The modules by the canonical paths of their files.
    known: HashMap<PathBuf, u32>,
    /// The files that are being read, each importing the next: canonical path and name.
    chain: Vec<(PathBuf, String)>,
}

impl Reader {
    /// Reads the script itself, whose text came from `path` or, without one, from elsewhere.
    pub fn script(&mut self, name: &str, content: Content, path: Option<&Path>) {
        let canonical = path.and_then(|path| path.canonicalize().ok());
        let folder = path.and_then(Path::parent).unwrap_or(Path::new(""));
        if let Content::TooLong(length) = content {
            self.program.sources.add(name, "");
            self.program.modules.push(Module::default());
            let mut error = Diagnostic::error(
                Span {
                    file: 0,
                    start: 0,
                    end: 0,
                },
                format!("`{name}` {}", too_long(length)),
            );
            error.span = None;
            self.diagnostics.push(error);
            return;
        }
        self.module(name, content, folder, canonical.unwrap_or_default());
    }

    /// Reads a file and its imports; the number of its module.
    fn module(&mut self, name: &str, content: Content, folder: &Path, canonical: PathBuf) -> u32 {
        let number = self.program.modules.len() as u32;
        self.program.modules.push(Module::default());
        self.known.insert(canonical.clone(), number);
        let (text, garbled) = match content {
            Content::Text(text) => (text, None),
            Content::Garbled(text, at) => (text, Some(at)),
            Content::TooLong(_) => (String::new(), None),
        };
        let file = self.program.sources.add(name, &text);
        if let Some(at) = garbled {
            self.diagnostics.push(not_utf8(file, &text, at));
            return number;
        }
        let mut parsed = syntax::parse(file, &text);
        self.diagnostics.append(&mut parsed.diagnostics);
        self.chain.push((canonical, name.into()));
        for statement in &mut parsed.statements {
            if let StatementKind::Import(import) = &mut statement.kind {
                import.module = self.import(&import.path, folder);
            }
        }
        self.chain.pop();
        let module = defined(parsed.statements, &mut self.diagnostics);
        self.program.modules[number as usize] = module;
        number
    }

    /// Reads an imported file once; none where it cannot be read.
    fn import(&mut self, path: &Word, folder: &Path) -> Option<u32> {
        let full = folder.join(&*path.text);
        let canonical = match full.canonicalize() {
            Ok(canonical) => canonical,
            Err(error) => return self.refused(path, unreadable(&path.text, &error)),
        };
        if let Some(at) = self.chain.iter().position(|(known, _)| *known == canonical) {
            let names: Vec<&str> = self.chain[at..].iter().map(|(_, name)| &**name).collect();
            let cycle = format!("{} -> {}", names.join(" -> "), names[0]);
            let message = format!("the imports form a cycle: {cycle}");
            return self.refused(path, (message, "a file may not import itself".into()));
        }
        if let Some(number) = self.known.get(&canonical) {
            return Some(*number);
        }
        if self.chain.len() > MAX_IMPORT_DEPTH {
            let message = format!(
                "more than {} import each other in a row (limit MAX_IMPORT_DEPTH)",
                counted(MAX_IMPORT_DEPTH, "file")
            );
            return self.refused(path, (message, String::new()));
        }
        let left = MAX_SCRIPT_BYTES.saturating_sub(self.program.sources.bytes());
        match content(&full, left) {
            Err(error) => self.refused(path, unreadable(&path.text, &error)),
            Ok(Content::TooLong(length)) => {
                let problem = format!("`{}` {}", path.text, too_long(length));
                self.refused(path, (problem, String::new()))
            }
            Ok(content) => {
                let name = full.display().to_string();
                let folder = full.parent().unwrap_or(Path::new("")).to_path_buf();
                Some(self.module(&name, content, &folder, canonical))
            }
        }
    }

    fn refused(&mut self, path: &Word, (message, help): (String, String)) -> Option<u32> {
        let mut error = Diagnostic::error(path.span, message);
        if !help.is_empty() {
            error = error.help(help);
        }
        self.diagnostics.push(error);
        None
    }

    /// Reads the values that the command line gives to parameters.
    pub fn overrides(&mut self, overrides: &[(String, String)]) {
        for (name, value) in overrides {
            let text = format!("{name}={value}");
            let file = self.program.sources.add("-D", &text);
            let part = |start: usize, end: usize| Word {
                text: text[start..end].into(),
                span: Span {
                    file,
                    start: start as u32,
                    end: end as u32,
                },
            };
            let parsed = syntax::parse_expression(file, &text, name.len() + 1);
            self.program.overrides.push(Override {
                name: part(0, name.len()),
                raw: part(name.len() + 1, text.len()),
                value: parsed,
            });
        }
    }
}

fn too_long(length: u64) -> String {
    format!(
        "is too long: {length} bytes, where a script and its imports may have {MAX_SCRIPT_BYTES} together (limit \
         MAX_SCRIPT_BYTES)"
    )
}

fn unreadable(path: &str, error: &io::Error) -> (String, String) {
    let reason = match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".into(),
        io::ErrorKind::PermissionDenied => "permission denied".into(),
        _ => error.to_string(),
    };
    let message = format!("cannot read `{path}`: {reason}");
    (
        message,
        "paths are relative to the file that imports".into(),
    )
}

fn not_utf8(file: u32, text: &str, at: usize) -> Diagnostic {
    let length = text[at..].chars().next().map_or(0, char::len_utf8);
    let span = Span {
        file,
        start: at as u32,
        end: (at + length) as u32,
    };
    Diagnostic::error(
        span,
        format!("the script is not UTF-8: bad byte at offset {at}"),
    )
    .help("scripts are plain text in UTF-8")
}

/// The module of these statements, with the names that they define; a name can be defined once.
fn defined(statements: Vec<Statement>, diagnostics: &mut Vec<Diagnostic>) -> Module {
    let mut module = Module::default();
    for (number, statement) in statements.iter().enumerate() {
        let index = module.globals.len() as u32;
        let define = name(&statement.kind).and_then(|name| {
            if let Some(first) = module.names.get(&name.text) {
                let first = module.globals[*first as usize].name.span;
                let message = format!("`{}` is defined twice", name.text);
                let error = Diagnostic::error(name.span, message)
                    .note(first, "first defined here")
                    .help("a name is given its value once; choose another");
                diagnostics.push(error);
                return None;
            }
            module.names.insert(name.text.clone(), index);
            module.globals.push(Global {
                name: name.clone(),
                statement: number,
            });
            Some(index)
        });
        module.defines.push(define);
    }
    module.statements = statements;
    module
}

/// The name that a statement defines.
fn name(kind: &StatementKind) -> Option<&Word> {
    match kind {
        StatementKind::Broken(name) => name.as_ref(),
        StatementKind::Import(import) => Some(&import.name),
        StatementKind::Parameter(parameter) => Some(&parameter.name),
        StatementKind::Let(name, _) | StatementKind::Material(name, _) => Some(name),
        StatementKind::Routine(routine) => Some(&routine.name),
        StatementKind::Show(_) | StatementKind::Settings(..) | StatementKind::Test(_) => None,
    }
}
