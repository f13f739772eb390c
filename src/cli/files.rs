//! Files that commands write: whether there is place for them, and what is said where they can't be written.

use super::failure::{Failure, reason};
use crate::output;
use std::io;
use std::path::Path;

/// Says before the work, and not after it, that a file could not be written.
///
/// # Errors
/// If the path is a folder, or its own folder does not exist.
pub fn has_place(path: &Path) -> Result<(), Failure> {
    let file = path.display();
    if path.is_dir() {
        return Err(Failure::Other(format!(
            "cannot write `{file}`: it is a folder"
        )));
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => return Ok(()),
    };
    let error = match folder.metadata() {
        Ok(metadata) if metadata.is_dir() => return Ok(()),
        Ok(_) => "it is not a folder".into(),
        Err(error) => reason(&error),
    };
    let folder = folder.display();
    Err(Failure::Other(format!(
        "cannot write `{file}`: the folder `{folder}`: {error}"
    )))
}

/// Writes a file, whole or not at all.
///
/// # Errors
/// If it can't be written; the message names it.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    output::write(path, bytes).map_err(|error| failed(path, &error))
}

/// The failure to write this file.
pub fn failed(path: &Path, error: &io::Error) -> Failure {
    Failure::writing(&format!("`{}`", path.display()), error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_folder_is_named() {
        let error = has_place(Path::new("no/such/folder/a.png")).unwrap_err();
        assert_eq!(
            error.to_string(),
            "cannot write `no/such/folder/a.png`: the folder `no/such/folder`: there is no such file or folder"
        );
        assert!(has_place(Path::new("a.png")).is_ok());
    }
}
