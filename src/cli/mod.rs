//! Floor 8: the command line. A file for each subcommand; what they share lies in files of its own.

mod bench;
mod bench_report;
mod budget;
mod chart;
mod chart_panels;
mod chart_tables;
mod check;
mod columns;
mod completions;
mod console;
mod eval;
mod explain;
mod failure;
mod files;
mod interrupt;
mod junit;
mod limits;
mod limits_matrix;
mod new;
mod outline;
mod progress;
mod reference;
mod refutations;
mod render;
mod script;
mod stats;
mod steps;
mod study;
mod study_constants;
mod study_counts;
mod study_errors;
mod study_precision;
mod table;
mod test;
mod trace;
mod tracing;
mod truth_cache;
mod value;

use clap::{CommandFactory, Parser, Subcommand};
use failure::Failure;
use std::ffi::OsString;
use std::process::ExitCode;

/// What is said under the list of subcommands.
const AFTER_HELP: &str = "\
Exit codes:
  0    all went well
  1    something failed: a file cannot be read or written, a test does not pass
  2    a script is wrong, or the command line is
  3    with `render --strict`: rays refuted a Lipschitz constant
  130  interrupted by Ctrl-C; no half-written file is left

Examples:
  fieldstone new scene.sdf             write a scene to start from
  fieldstone render scene.sdf          make scene.png of it
  fieldstone render scene.sdf -D n=7   with another value for its parameter `n`
  fieldstone explain scene.sdf         what is known of its shapes, and how rays find them

Colours are left out where NO_COLOR is set, and where the output is no terminal. What the slow reference of charts says of a \
scene is kept in FIELDSTONE_CACHE (a folder, or `off`), else in the user's cache folder, up to 256 MB.";

/// Models implicit surfaces with a script and renders them with certified ray tracing.
#[derive(Debug, Parser)]
#[command(name = "fieldstone", version, arg_required_else_help = true, after_help = AFTER_HELP)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
enum Command {
    Render(render::Arguments),
    Check(check::Arguments),
    New(new::Arguments),
    Bench(bench::Arguments),
    Chart(chart::Arguments),
    Steps(steps::Arguments),
    Explain(explain::Arguments),
    Eval(eval::Arguments),
    Trace(trace::Arguments),
    Test(test::Arguments),
    Limits(limits::Arguments),
    Reference(reference::Arguments),
    Completions(completions::Arguments),
}

/// Runs the command and gives its exit code.
pub fn main() -> ExitCode {
    match Cli::try_parse() {
        Ok(cli) => ended(run(&cli.command)),
        Err(error) => refused(&error),
    }
}

fn run(command: &Command) -> Result<(), Failure> {
    match command {
        Command::Render(arguments) => render::run(arguments),
        Command::Check(arguments) => check::run(arguments),
        Command::New(arguments) => new::run(arguments),
        Command::Bench(arguments) => bench::run(arguments),
        Command::Chart(arguments) => chart::run(arguments),
        Command::Steps(arguments) => steps::run(arguments),
        Command::Explain(arguments) => explain::run(arguments),
        Command::Eval(arguments) => eval::run(arguments),
        Command::Trace(arguments) => trace::run(arguments),
        Command::Test(arguments) => test::run(arguments),
        Command::Limits(arguments) => limits::run(arguments),
        Command::Reference(arguments) => reference::run(arguments),
        Command::Completions(arguments) => completions::run(arguments, Cli::command()),
    }
}

/// Says what failed, if anything did and it has not been said, and gives the exit code.
fn ended(result: Result<(), Failure>) -> ExitCode {
    let Err(failure) = result else {
        return ExitCode::SUCCESS;
    };
    let message = failure.to_string();
    if !message.is_empty() {
        console::say_error(&message);
    }
    ExitCode::from(failure.code())
}

/// Prints help, version or what is wrong with the command line. Nobody is told where that is impossible.
fn refused(error: &clap::Error) -> ExitCode {
    let _ = error.print();
    if let Some(script) = lone_script(std::env::args_os().skip(1)) {
        console::say_line(&format!(
            "\n  tip: to make a picture, write 'fieldstone render {script}'"
        ));
    }
    ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2))
}

/// The script that stands where a subcommand is wanted, if one does.
fn lone_script(arguments: impl Iterator<Item = OsString>) -> Option<String> {
    let mut arguments = arguments;
    let first = arguments.next()?.into_string().ok()?;
    first.ends_with(".sdf").then_some(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn definitions_of_all_subcommands_are_sound() {
        Cli::command().debug_assert();
    }

    #[test]
    fn every_subcommand_has_examples() {
        for command in Cli::command().get_subcommands() {
            let help = command.get_after_help().map(ToString::to_string);
            let name = command.get_name();
            let has_example = help.is_some_and(|h| h.contains(&format!("fieldstone {name}")));
            assert!(has_example, "{name}");
        }
    }

    #[test]
    fn points_with_minus_signs_are_values() {
        let cli = Cli::try_parse_from(["fieldstone", "eval", "a.sdf", "--at", "-1,0,-0.5"]);
        assert!(cli.is_ok());
    }

    #[test]
    fn script_without_a_subcommand_is_recognised() {
        let lone = |words: &[&str]| lone_script(words.iter().map(OsString::from));
        assert_eq!(lone(&["a.sdf", "-o", "b.png"]).as_deref(), Some("a.sdf"));
        assert_eq!(lone(&["render", "a.sdf"]), None);
        assert_eq!(lone(&[]), None);
    }
}
