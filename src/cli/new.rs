//! `fieldstone new`: a scene to start from.

use super::console::say_line;
use super::failure::Failure;
use super::files;
use clap::Args;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// The scene that every new file starts with.
const STARTER: &str = include_str!("starter.sdf");

const AFTER_HELP: &str = "\
Examples:
  fieldstone new scene.sdf
  fieldstone render scene.sdf";

/// Write a commented scene to start from
///
/// A file that exists is never overwritten.
#[derive(Args, Debug)]
#[command(after_help = AFTER_HELP)]
pub struct Arguments {
    /// The file to write; `.sdf` is added where the name has no ending
    #[arg(value_name = "NAME.sdf")]
    path: PathBuf,
}

/// Writes the scene.
///
/// # Errors
/// If the file exists or can't be written; then it is as it was.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let path = with_ending(&arguments.path);
    let name = path.display();
    files::has_place(&path)?;
    create(&path).map_err(|error| files::failed(&path, &error))?;
    say_line(&format!(
        "wrote {name}; for its picture: fieldstone render {name}"
    ));
    Ok(())
}

fn with_ending(path: &Path) -> PathBuf {
    if path.extension().is_some() {
        path.to_path_buf()
    } else {
        path.with_extension("sdf")
    }
}

/// Creates the file, whole or not at all.
fn create(path: &Path) -> io::Result<()> {
    let mut file = File::create_new(path)?;
    let written = file
        .write_all(STARTER.as_bytes())
        .and_then(|()| file.sync_all());
    if written.is_err() {
        // The file is ours and incomplete; the error that matters is the first.
        let _ = fs::remove_file(path);
    }
    written
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ending_is_added_where_there_is_none() {
        assert_eq!(with_ending(Path::new("a/b")), Path::new("a/b.sdf"));
        assert_eq!(with_ending(Path::new("b.sdf")), Path::new("b.sdf"));
        assert_eq!(with_ending(Path::new("b.txt")), Path::new("b.txt"));
    }
}
