//! `fieldstone test`: the tests of scripts.

use super::console::{GREEN, RED, answer, answers_color, colored};
use super::failure::Failure;
use super::script::Scripts;
use crate::trace::SceneTracer;
use clap::Args;
use std::path::Path;

const AFTER_HELP: &str = "\
A script's tests are its blocks `test \"name\" { expect ... }`. The closing line is `N passed, N failed`; the exit \
code is 0 if all tests pass, 1 if some fail, and 2 if a script is wrong.

Examples:
  fieldstone test scene.sdf
  fieldstone test examples/*.sdf
  fieldstone test gear.sdf -D teeth=30";

/// Run the `test` blocks of scripts
#[derive(Args, Debug)]
#[command(after_help = AFTER_HELP)]
pub struct Arguments {
    #[command(flatten)]
    scripts: Scripts,
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
/// If a test fails, or a script can't be read or is wrong.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scripts = &arguments.scripts;
    let mut tally = Tally::default();
    let color = answers_color();
    let loaded = scripts.each(|path, loaded| {
        if scripts.len() > 1 {
            answer(&format!("{}\n", heading(path)))?;
        }
        for test in loaded.run_tests(&SceneTracer::default()) {
            let has_passed = test.failures.is_empty();
            answer(&verdict(&test.name, has_passed, color))?;
            if has_passed {
                tally.passed += 1;
            } else {
                tally.failed += 1;
                answer(&format!("\n{}", test.failures.render(color)))?;
            }
        }
        Ok(())
    });
    if !matches!(loaded, Err(Failure::Closed)) {
        answer(&closing(tally))?;
    }
    loaded?;
    if tally.failed > 0 {
        return Err(Failure::Other(String::new()));
    }
    Ok(())
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
