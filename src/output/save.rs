//! A film as files, one for each channel.

use super::file::Staged;
use super::picture;
use super::png::{Metadata, encode};
use crate::render::{Channel, Film};
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// Why a film could not be saved.
#[derive(Debug)]
pub struct SaveError {
    /// The file at fault.
    pub path: PathBuf,
    /// What happened to it.
    pub source: io::Error,
}

impl fmt::Display for SaveError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "can't write {}: {}", self.path.display(), self.source)
    }
}

impl std::error::Error for SaveError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.source)
    }
}

/// The file of a channel: `path` itself for the only channel or the beauty, `name.depth.png` for another of several.
pub fn path_of(path: &Path, channel: Channel, is_only: bool) -> PathBuf {
    if is_only || channel == Channel::Beauty {
        return path.to_path_buf();
    }
    let mut name = path.file_stem().unwrap_or_default().to_os_string();
    name.push(".");
    name.push(channel.name());
    if let Some(extension) = path.extension() {
        name.push(".");
        name.push(extension);
    }
    path.with_file_name(name)
}

/// A file that was saved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Saved {
    /// Where it is.
    pub path: PathBuf,
    /// What it shows.
    pub channel: Channel,
    /// How many of its pixels were not a number, and are black.
    pub not_a_number: u64,
}

/// Writes every channel of `film` as a PNG, named by [`path_of`]: all of them, or none.
///
/// # Errors
/// If a file can't be written; then none is there, and what was there before is as it was, unless the renaming of finished
/// files itself fails half way.
pub fn save(film: &Film, path: &Path, metadata: &Metadata) -> Result<Vec<Saved>, SaveError> {
    let is_only = film.planes().len() == 1;
    let mut staged = Vec::new();
    let mut saved = Vec::new();
    for channel in film.planes().iter().map(|plane| plane.channel) {
        let Some(picture) = picture(film, channel) else {
            continue;
        };
        let path = path_of(path, channel, is_only);
        let file = encode(&picture.image, metadata)
            .map_err(io::Error::other)
            .and_then(|bytes| Staged::new(&path, &bytes));
        match file {
            Ok(file) => staged.push(file),
            Err(source) => return Err(SaveError { path, source }),
        }
        saved.push(Saved {
            path,
            channel,
            not_a_number: picture.not_a_number,
        });
    }
    for (file, saved) in staged.into_iter().zip(&saved) {
        file.commit().map_err(|source| SaveError {
            path: saved.path.clone(),
            source,
        })?;
    }
    Ok(saved)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_have_files_of_their_own() {
        let name = |channel, only| {
            path_of(Path::new("a/out.png"), channel, only)
                .to_string_lossy()
                .into_owned()
        };
        assert_eq!(name(Channel::Beauty, false), "a/out.png");
        assert_eq!(name(Channel::Depth, false), "a/out.depth.png");
        assert_eq!(name(Channel::Depth, true), "a/out.png");
    }

    #[test]
    fn one_file_that_fails_takes_back_the_others() {
        let folder = std::env::temp_dir().join(format!("fieldstone-save-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(folder.join("out.depth.png")).unwrap();
        let film = Film::new([2, 2], &[Channel::Beauty, Channel::Depth]);
        let error = save(&film, &folder.join("out.png"), &Metadata::default()).unwrap_err();
        assert!(error.path.ends_with("out.depth.png"));
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
        std::fs::remove_dir_all(folder).unwrap();
    }
}
