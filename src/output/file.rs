//! Files that are there as a whole or not at all.
//!
//! What is written goes to a temporary file beside the target, which takes the target's name once all of it is on the
//! disk. Whatever fails on the way removes the temporary file.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The temporary files that exist now, for whoever ends the program early.
static LIVE: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn live() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    LIVE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes all temporary files; for an interrupt handler that is about to end the program.
pub fn remove_temporaries() {
    for path in std::mem::take(&mut *live()) {
        // What can't be removed can't be helped: the program ends.
        let _ = fs::remove_file(path);
    }
}

/// Writes `bytes` to `path`, all of them or nothing. A target that is no regular file, as a pipe, is written to directly.
///
/// # Errors
/// If the folder does not exist or can't be written to, the disk is full, or the target is a folder.
pub fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    Staged::new(path, bytes)?.commit()
}

/// A file that is written, but has not taken its name yet; unless it does, it is removed.
pub struct Staged {
    target: PathBuf,
    temporary: Option<PathBuf>,
    /// What goes to a target that is no regular file.
    stream: Option<Vec<u8>>,
}

impl Staged {
    /// `bytes` on the disk, beside `target`.
    ///
    /// # Errors
    /// As [`write()`].
    pub fn new(target: &Path, bytes: &[u8]) -> io::Result<Self> {
        // Through a symbolic link, the file that it names is replaced, and not the link.
        let target = fs::canonicalize(target).unwrap_or_else(|_| target.to_path_buf());
        if target.is_dir() {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        if target.exists() && !target.is_file() {
            return Ok(Self {
                target,
                temporary: None,
                stream: Some(bytes.to_vec()),
            });
        }
        let temporary = beside(&target)?;
        live().insert(temporary.clone());
        let staged = Self {
            target,
            temporary: Some(temporary.clone()),
            stream: None,
        };
        let mut file = OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&temporary)?;
        file.write_all(bytes)?;
        file.sync_all()?;
        Ok(staged)
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// If it can't be renamed, or the stream is closed.
    pub fn commit(mut self) -> io::Result<()> {
        if let Some(bytes) = &self.stream {
            return File::options()
                .write(true)
                .open(&self.target)?
                .write_all(bytes);
        }
        if let Some(temporary) = &self.temporary {
            fs::rename(temporary, &self.target)?;
            live().remove(temporary);
            self.temporary = None;
        }
        Ok(())
    }
}

impl Drop for Staged {
    fn drop(&mut self) {
        if let Some(temporary) = &self.temporary {
            // It may not exist: then opening it was what failed.
            let _ = fs::remove_file(temporary);
            live().remove(temporary);
        }
    }
}

/// A name for a temporary file in the folder of `target` that no other thread or process uses.
fn beside(target: &Path) -> io::Result<PathBuf> {
    static NUMBER: AtomicU64 = AtomicU64::new(0);
    let name = target.file_name().ok_or(io::ErrorKind::InvalidInput)?;
    let mut hidden = std::ffi::OsString::from(".");
    hidden.push(name);
    hidden.push(format!(
        ".{}-{}.tmp",
        std::process::id(),
        NUMBER.fetch_add(1, Ordering::Relaxed)
    ));
    Ok(target.with_file_name(hidden))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An empty folder of its own for a test.
    fn folder(name: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("fieldstone-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir(&path).unwrap();
        path
    }

    fn names(folder: &Path) -> Vec<String> {
        fs::read_dir(folder)
            .unwrap()
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect()
    }

    #[test]
    fn a_file_is_replaced_as_a_whole() {
        let folder = folder("replaced");
        let path = folder.join("a.png");
        write(&path, b"old").unwrap();
        write(&path, b"new and longer").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new and longer");
        assert_eq!(names(&folder), ["a.png"]);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_failed_write_leaves_nothing() {
        let folder = folder("failed");
        assert!(write(&folder.join("missing/a.png"), b"x").is_err());
        fs::create_dir(folder.join("b.png")).unwrap();
        assert!(write(&folder.join("b.png"), b"x").is_err());
        assert_eq!(names(&folder), ["b.png"]);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn what_is_not_committed_is_removed() {
        let folder = folder("dropped");
        let path = folder.join("a.png");
        write(&path, b"old").unwrap();
        drop(Staged::new(&path, b"new").unwrap());
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(&folder), ["a.png"]);
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_an_error_and_stays_a_device() {
        assert!(write(Path::new("/dev/full"), b"x").is_err());
        write(Path::new("/dev/null"), b"x").unwrap();
        assert!(!Path::new("/dev/null").is_file());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_keeps_pointing_to_its_file() {
        let folder = folder("link");
        let (file, link) = (folder.join("file.png"), folder.join("link.png"));
        fs::write(&file, b"old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write(&link, b"new").unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        fs::remove_dir_all(folder).unwrap();
    }
}
