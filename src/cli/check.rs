//! `fieldstone check`: everything that is wrong with scripts, without a picture.

use super::console::{answer, counted};
use super::failure::Failure;
use super::script::{Scripts, compile};
use clap::Args;

const AFTER_HELP: &str = "\
Examples:
  fieldstone check scene.sdf
  fieldstone check examples/*.sdf
  fieldstone check scene.sdf -D teeth=30";

/// Say everything that is wrong with scripts; nothing is rendered
///
/// Loads each script as `render` does and compiles its shapes. Errors and warnings go to standard error.
#[derive(Args, Debug)]
#[command(after_help = AFTER_HELP)]
pub struct Arguments {
    #[command(flatten)]
    scripts: Scripts,
}

/// Checks the scripts.
///
/// # Errors
/// If one of them can't be read or is wrong.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scripts = &arguments.scripts;
    scripts.each(|_, loaded| compile(&loaded.scene).map(drop))?;
    answer(&format!("{} ok\n", counted(scripts.len(), "scene")))
}
