//! `fieldstone test`: the tests of scripts.

use super::console::{GREEN, RED, answer, answers_color, colored};
use super::failure::Failure;
use super::files;
use super::junit::{self, Case, Suite};
use super::script::Scripts;
use crate::lang::TestResult;
use crate::render::CameraTracer;
use crate::scene::CameraRecord;
use clap::Args;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

const AFTER_HELP: &str = "\
A script's tests are its blocks `test \"name\" { expect ... }` and its `budget { mean_steps: 20, p99_steps: 80, unknown: 0 }`, \
which the camera's rays may not exceed. The closing line is `N passed, N failed`; the exit \
code is 0 if all tests pass, 1 if some fail, and 2 if a script is wrong.

Examples:
  fieldstone test scene.sdf
  fieldstone test examples/*.sdf
  fieldstone test gear.sdf -D teeth=30
  fieldstone test examples/*.sdf --junit results.xml";

/// Run the `test` blocks of scripts
#[derive(Args, Debug)]
#[command(after_help = AFTER_HELP)]
pub struct Arguments {
    #[command(flatten)]
    scripts: Scripts,
    /// Write the results to this file, in JUnit's XML
    #[arg(long, value_name = "FILE.xml")]
    junit: Option<PathBuf>,
    /// Answer in JSON
    #[arg(long)]
    json: bool,
}

/// How many tests passed and failed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Tally {
    passed: usize,
    failed: usize,
}

/// Runs the tests and prints what became of them.
///
/// # Errors
/// If a test fails, a script can't be read or is wrong, or the file can't be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(path) = &arguments.junit {
        files::has_place(path)?;
    }
    let scripts = &arguments.scripts;
    let mut tally = Tally::default();
    let mut suites = Vec::new();
    let loaded = scripts.each(|path, loaded| {
        if scripts.len() > 1 && !arguments.json {
            answer(&format!("{}\n", heading(path)))?;
        }
        let mut cases = Vec::new();
        for test in loaded.run_tests(&CameraTracer::default()) {
            if !arguments.json {
                tell(&test)?;
            }
            let has_passed = test.failures.is_empty();
            tally.passed += usize::from(has_passed);
            tally.failed += usize::from(!has_passed);
            cases.push(Case {
                reached: test.record.as_deref().map(reached),
                failure: (!has_passed).then(|| test.failures.render(false)),
                name: test.name,
            });
        }
        suites.push((path.to_path_buf(), cases));
        Ok(())
    });
    if !matches!(loaded, Err(Failure::Closed)) {
        report(arguments, suites, tally)?;
    }
    loaded?;
    if tally.failed > 0 {
        return Err(Failure::Other(String::new()));
    }
    Ok(())
}

/// Says what became of a test.
fn tell(test: &TestResult) -> Result<(), Failure> {
    let color = answers_color();
    let has_passed = test.failures.is_empty();
    answer(&verdict(&test.name, has_passed, color))?;
    if has_passed {
        return Ok(());
    }
    answer(&format!("\n{}", test.failures.render(color)))
}

/// Writes the files that were asked for, and the closing line or the whole answer in JSON.
fn report(
    arguments: &Arguments,
    done: Vec<(PathBuf, Vec<Case>)>,
    tally: Tally,
) -> Result<(), Failure> {
    let mut done = done.into_iter().peekable();
    let suite = |path: &PathBuf| Suite {
        script: path.display().to_string(),
        // They are in the order of the scripts; those that could not be loaded are missing.
        cases: done
            .next_if(|(loaded, _)| loaded == path)
            .map(|(_, cases)| cases),
    };
    let suites: Vec<Suite> = arguments.scripts.paths().iter().map(suite).collect();
    if let Some(path) = &arguments.junit {
        files::write(path, junit::xml(&suites).as_bytes())?;
    }
    answer(&if arguments.json {
        junit::in_json(&suites)
    } else {
        closing(tally)
    })
}

/// What the camera's rays took, for programs.
fn reached(record: &CameraRecord) -> Value {
    json!({
        "mean_steps": record.mean_steps,
        "p99_steps": record.p99_steps,
        "max_steps": record.max_steps,
        "longest": record.longest,
        "mean_evaluations": record.mean_evaluations,
        "unknown": record.unknown,
    })
}

fn heading(path: &Path) -> String {
    format!("{}:", path.display())
}

/// The line for a test.
fn verdict(name: &str, has_passed: bool, color: bool) -> String {
    let word = if has_passed {
        colored("ok", GREEN, color)
    } else {
        colored("FAILED", RED, color)
    };
    format!("test \"{name}\" ... {word}\n")
}

/// The closing line.
fn closing(tally: Tally) -> String {
    format!("{} passed, {} failed\n", tally.passed, tally.failed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_plain_without_colour() {
        assert_eq!(verdict("a b", true, false), "test \"a b\" ... ok\n");
        assert_eq!(verdict("c", false, false), "test \"c\" ... FAILED\n");
        let tally = Tally {
            passed: 3,
            failed: 0,
        };
        assert_eq!(closing(tally), "3 passed, 0 failed\n");
    }
}
