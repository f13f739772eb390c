//! `fieldstone limits`: where methods fail.

use super::console::{answer, say};
use super::failure::Failure;
use super::limits_matrix::{Cell, Limit, Matrix};
use super::tracing;
use crate::lang::{self, LoadError, Loaded};
use crate::render::CameraTracer;
use crate::scene::Method;
use crate::trace::SceneTracer;
use clap::Args;
use rayon::prelude::*;
use std::fs;
use std::path::{Path, PathBuf};

const AFTER_HELP: &str = "\
A limit is a script that begins with a comment line `// 14. Name: what fails and why`. Its `test` blocks say by `hits` and \
`misses` what rays should find; they are run by every method, whatever method the script itself asks for. A script that \
must not load has a line `// refused: part of the message`; one that is no matter of rays has `// see: where it is tested`. \
The answer is a table in Markdown. The exit code is 1 if the default method is wrong anywhere.

Examples:
  fieldstone limits
  fieldstone limits --method auto --method sphere
  fieldstone limits my/limits > limits.md";

/// Trace what methods are known to fail at, by every method
#[derive(Args, Debug)]
#[command(after_help = AFTER_HELP)]
pub struct Arguments {
    /// The folder of the scripts
    #[arg(value_name = "DIR", default_value = "tests/limits")]
    folder: PathBuf,
    /// A method; may be given several times [default: all]
    #[arg(long = "method", value_name = "NAME", value_parser = tracing::method())]
    methods: Vec<Method>,
}

/// Runs every script by every method and prints the matrix.
///
/// # Errors
/// If a script can't be read, is wrong, or says nothing; or if the default method is wrong.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let methods = match &arguments.methods[..] {
        [] => Method::ALL.iter().map(|(_, method)| *method).collect(),
        chosen => chosen.to_vec(),
    };
    let limits: Vec<Limit> = scripts(&arguments.folder)?
        .par_iter()
        .map(|path| limit(path, &methods))
        .collect::<Result<_, _>>()?;
    let matrix = Matrix::new(methods, limits);
    answer(&matrix.to_string())?;
    match &matrix.wrong_by(Method::Auto)[..] {
        [] => Ok(()),
        wrong => Err(Failure::Other(format!(
            "the default method is wrong at {}",
            wrong.join(", ")
        ))),
    }
}

/// The scripts of a folder, in order.
fn scripts(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let name = format!("`{}`", folder.display());
    let entries = fs::read_dir(folder).map_err(|error| Failure::reading(&name, &error))?;
    let mut scripts: Vec<PathBuf> = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|e| e == "sdf"))
        .collect();
    if scripts.is_empty() {
        return Err(Failure::Other(format!("there is no script in {name}")));
    }
    scripts.sort();
    Ok(scripts)
}

/// What a script says of itself in its first lines.
struct Header {
    number: u32,
    name: String,
    refused: Option<String>,
    see: Option<String>,
}

impl Header {
    fn of(text: &str) -> Option<Self> {
        let mut lines = text.lines();
        let (number, rest) = lines.next()?.strip_prefix("// ")?.split_once(". ")?;
        let (name, _) = rest.split_once(':')?;
        let comments = lines.map_while(|line| line.strip_prefix("// "));
        let directive = |word: &str| {
            let mut found = comments.clone().filter_map(|line| line.strip_prefix(word));
            found.next().map(|rest| rest.trim().to_string())
        };
        Some(Self {
            number: number.parse().ok()?,
            name: name.into(),
            refused: directive("refused:"),
            see: directive("see:"),
        })
    }
}

/// Runs one script by all methods.
fn limit(path: &Path, methods: &[Method]) -> Result<Limit, Failure> {
    let shown = path.display();
    let text = fs::read_to_string(path)
        .map_err(|error| Failure::reading(&format!("`{shown}`"), &error))?;
    let Some(header) = Header::of(&text) else {
        let wanted = "`// 14. Name: what fails and why`";
        return Err(Failure::Other(format!(
            "`{shown}` must begin with a line as {wanted}"
        )));
    };
    let cells = match (&header.see, &header.refused) {
        (Some(_), _) => Vec::new(),
        (None, Some(words)) => vec![refused(path, words)?; methods.len()],
        (None, None) => traced(path, methods)?,
    };
    Ok(Limit {
        number: header.number,
        name: header.name,
        cells,
        see: header.see,
    })
}

/// Whether the script is refused with these words.
fn refused(path: &Path, words: &str) -> Result<Cell, Failure> {
    match lang::load(path, &[], &SceneTracer::default()) {
        Ok(_) => Ok(Cell::Accepted),
        Err(LoadError::Script(report)) if report.iter().any(|d| d.message.contains(words)) => {
            Ok(Cell::Refused)
        }
        Err(error) => Err(unusable(path, &error)),
    }
}

/// How the rays of a script fare by each method.
fn traced(path: &Path, methods: &[Method]) -> Result<Vec<Cell>, Failure> {
    let mut loaded =
        lang::load(path, &[], &SceneTracer::default()).map_err(|error| unusable(path, &error))?;
    if loaded.tests().is_empty() {
        let shown = path.display();
        return Err(Failure::Other(format!("`{shown}` has no `test` block")));
    }
    let cells = methods.iter().map(|method| by_method(&mut loaded, *method));
    Ok(cells.collect())
}

fn by_method(loaded: &mut Loaded, method: Method) -> Cell {
    loaded.scene.settings.method = method;
    let results = loaded.run_tests(&CameraTracer::default());
    let judgements = results.iter().flat_map(|result| &result.judgements);
    let steps = results.iter().map(|result| result.steps).max().unwrap_or(0);
    Cell::of(judgements, steps)
}

fn unusable(path: &Path, error: &LoadError) -> Failure {
    say(&error.to_string());
    Failure::Other(format!("`{}` can't be used", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_name_the_limit() {
        let header = Header::of("// 14. Repeat seam: copies\n// see: tests/a.rs\nshow box(1)\n");
        let header = header.expect("a header");
        assert_eq!((header.number, &*header.name), (14, "Repeat seam"));
        assert_eq!(header.see.as_deref(), Some("tests/a.rs"));
        assert_eq!(header.refused, None);
        assert!(Header::of("show box(1)\n// 1. a: b\n").is_none());
    }
}
