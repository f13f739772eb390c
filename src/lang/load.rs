//! Loading a script: the whole way from its text to a scene.

use super::ast::{StatementKind, TestBlock};
use super::budget::Budget;
use super::limits::{MAX_SCRIPT_BYTES, STACK_BYTES};
use super::machine::{Global, Machine};
use super::program::{Content, Program, Reader, content};
use super::report::{Diagnostic, Level, Report};
use super::resolve::resolve;
use super::source::Span;
use super::statements::Made;
use super::trial::TestResult;
use crate::scene::{Mark, Node, Scene, Tracer};
use std::collections::BTreeMap;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A script that was loaded.
pub struct Loaded {
    /// What it shows.
    pub scene: Scene,
    /// The shapes that it gives names to: every `let` and `field` at the top.
    pub names: BTreeMap<String, Arc<Node>>,
    /// Its parameters with their values, as `-D` would take them.
    pub parameters: Vec<(String, String)>,
    /// What is odd about it, but no error.
    pub warnings: Report,
    budget: Option<Budget>,
    program: Program,
    globals: Vec<Vec<Global>>,
}

/// Why a script could not be loaded.
#[derive(Debug)]
pub enum LoadError {
    /// The file could not be read.
    Io {
        /// The file.
        path: PathBuf,
        /// Why not.
        error: io::Error,
    },
    /// The script is wrong.
    Script(Report),
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io { path, error } => write!(f, "cannot read `{}`: {error}", path.display()),
            Self::Script(report) => report.fmt(f),
        }
    }
}

impl std::error::Error for LoadError {}

impl fmt::Debug for Loaded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Loaded")
            .field("scene", &self.scene)
            .field("names", &self.names.keys())
            .field("parameters", &self.parameters)
            .field("warnings", &self.warnings)
            .finish_non_exhaustive()
    }
}

/// Loads a script from a file, with what it imports. Each override gives a parameter the value that its second part
/// says, as on the command line; `tracer` answers `trace`.
///
/// # Errors
/// If the file cannot be read, or the script is wrong.
pub fn load(
    path: &Path,
    overrides: &[(String, String)],
    tracer: &dyn Tracer,
) -> Result<Loaded, LoadError> {
    let name = path.display().to_string();
    let content = content(path, MAX_SCRIPT_BYTES).map_err(|error| LoadError::Io {
        path: path.into(),
        error,
    })?;
    on_large_stack(|| loaded(&name, content, Some(path), overrides, tracer))
        .map_err(LoadError::Script)
}

/// Loads a script from a text that messages call `name`; imports are relative to the current folder.
///
/// # Errors
/// If the script is wrong.
pub fn load_text(
    name: &str,
    text: &str,
    overrides: &[(String, String)],
    tracer: &dyn Tracer,
) -> Result<Loaded, Report> {
    let content = if text.len() > MAX_SCRIPT_BYTES {
        Content::TooLong(text.len() as u64)
    } else {
        Content::Text(text.into())
    };
    on_large_stack(|| loaded(name, content, None, overrides, tracer))
}

impl Loaded {
    /// The names of the script's `test` blocks, in order.
    pub fn tests(&self) -> Vec<&str> {
        self.test_blocks().map(|test| &*test.name.text).collect()
    }

    /// A warning about what stands at a place of the script, if it is known, as text with the lines around it.
    pub fn warning(
        &self,
        mark: Option<Mark>,
        message: String,
        label: String,
        help: &str,
    ) -> Report {
        let warning = Diagnostic {
            level: Level::Warning,
            message,
            span: mark.map(Span::marked),
            label,
            help: Some(help.into()),
            notes: Vec::new(),
        };
        Report::new(vec![warning], self.program.sources.clone())
    }

    fn test_blocks(&self) -> impl Iterator<Item = &TestBlock> {
        let statements = self.program.modules[0].statements.iter();
        statements.filter_map(|statement| match &statement.kind {
            StatementKind::Test(test) => Some(test),
            _ => None,
        })
    }

    /// Runs the script's `test` blocks, in order, and then holds its `budget` against what the camera's rays take.
    pub fn run_tests(&self, tracer: &dyn Tracer) -> Vec<TestResult> {
        on_large_stack(|| {
            let mut machine = Machine::new(&self.program, tracer);
            machine.globals.clone_from(&self.globals);
            machine.shown.clone_from(&self.scene.shown);
            machine.settings = self.scene.settings;
            machine.camera = Some(self.scene.camera);
            let report = |failures| Report::new(failures, self.program.sources.clone());
            let mut results: Vec<TestResult> = Vec::new();
            for test in self.test_blocks() {
                let failures = report(machine.test(test));
                let fates = std::mem::take(&mut machine.fates);
                results.push(TestResult {
                    name: test.name.text.to_string(),
                    failures,
                    judgements: fates.judgements,
                    steps: fates.steps,
                    record: None,
                });
            }
            if let Some(budget) = &self.budget {
                let failures = report(machine.hold(budget));
                let record = machine.record.clone();
                results.push(TestResult::of_budget(failures, record));
            }
            results
        })
    }
}

/// Runs `work` on a thread with a stack that is large enough for the deepest script.
fn on_large_stack<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new()
            .name("script".into())
            .stack_size(STACK_BYTES)
            .spawn_scoped(scope, work)
            .expect("the system gives one more thread");
        match thread.join() {
            Ok(result) => result,
            Err(panic) => std::panic::resume_unwind(panic),
        }
    })
}

fn loaded(
    name: &str,
    content: Content,
    path: Option<&Path>,
    overrides: &[(String, String)],
    tracer: &dyn Tracer,
) -> Result<Loaded, Report> {
    let mut reader = Reader::default();
    reader.script(name, content, path);
    reader.overrides(overrides);
    let Reader {
        mut program,
        mut diagnostics,
        ..
    } = reader;
    let has_parse_errors = !diagnostics.is_empty();
    diagnostics.extend(resolve(&mut program, has_parse_errors));
    let mut machine = Machine::new(&program, tracer);
    let Made {
        scene,
        names,
        parameters,
        budget,
        has_shows,
        ..
    } = machine.run();
    let globals = std::mem::take(&mut machine.globals);
    diagnostics.append(&mut machine.diagnostics);
    drop(machine);
    let is_error = |d: &Diagnostic| d.level == Level::Error;
    let has_errors = diagnostics.iter().any(is_error);
    if !has_errors && !has_shows {
        diagnostics.push(shows_nothing());
    }
    let report = Report::new(diagnostics, program.sources.clone());
    if has_errors {
        return Err(report);
    }
    Ok(Loaded {
        scene,
        names,
        parameters,
        warnings: report,
        budget,
        program,
        globals,
    })
}

fn shows_nothing() -> Diagnostic {
    Diagnostic {
        level: Level::Warning,
        message: "the script shows nothing".into(),
        span: None,
        label: String::new(),
        help: Some("end it with `show` and a shape, as in `show sphere(1)`".into()),
        notes: Vec::new(),
    }
}
