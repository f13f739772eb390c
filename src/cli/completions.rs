//! `fieldstone completions`: scripts that let a shell complete the command's words.

use super::console::answer_bytes;
use super::failure::Failure;
use clap::{Args, Command};
use clap_complete::Shell;

const AFTER_HELP: &str = "\
Examples:
  fieldstone completions bash > ~/.local/share/bash-completion/completions/fieldstone
  fieldstone completions zsh > ~/.zfunc/_fieldstone
  fieldstone completions fish > ~/.config/fish/completions/fieldstone.fish";

/// Print a script that completes the command's words in a shell
#[derive(Args, Debug)]
#[command(after_help = AFTER_HELP)]
pub struct Arguments {
    /// The shell
    shell: Shell,
}

/// Prints the script for `command`.
///
/// # Errors
/// If standard output can't take it.
pub fn run(arguments: &Arguments, mut command: Command) -> Result<(), Failure> {
    let mut script = Vec::new();
    let name = command.get_name().to_string();
    clap_complete::generate(arguments.shell, &mut command, name, &mut script);
    answer_bytes(&script)
}
