//! How a command ends when it does not end well, and the exit code that says so.

use std::fmt;
use std::io;
use std::process::ExitCode;

/// Why a command stopped.
#[derive(Debug)]
pub enum Failure {
    /// A script is wrong; what is wrong has been said already.
    Script,
    /// The command was called in a way that makes no sense.
    Usage(String),
    /// A bound was refuted while `--strict` asks that none is; it has been said already.
    Refuted,
    /// Anything else that fails; empty where it has been said already.
    Other(String),
    /// Whoever reads the output has enough of it.
    Closed,
    /// The user stopped it.
    Interrupted,
}

impl Failure {
    /// The exit code: 1 for anything that fails, 2 for a script or a call that is wrong, 3 for a bound that is refuted, 130
    /// for an interruption.
    pub fn code(&self) -> u8 {
        match self {
            Self::Closed => 0,
            Self::Other(_) => 1,
            Self::Script | Self::Usage(_) => 2,
            Self::Refuted => 3,
            Self::Interrupted => 130,
        }
    }

    /// The failure to write to `target`; a closed pipe is the quiet end.
    pub fn writing(target: &str, error: &io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe {
            return Self::Closed;
        }
        Self::Other(format!("cannot write {target}: {}", reason(error)))
    }

    /// The failure to read `source`.
    pub fn reading(source: &str, error: &io::Error) -> Self {
        Self::Other(format!("cannot read {source}: {}", reason(error)))
    }
}

impl From<&Failure> for ExitCode {
    fn from(failure: &Failure) -> Self {
        Self::from(failure.code())
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Usage(message) | Self::Other(message) => f.write_str(message),
            Self::Interrupted => f.write_str("interrupted"),
            Self::Script | Self::Refuted | Self::Closed => Ok(()),
        }
    }
}

/// What went wrong with a file, in a few words.
pub fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file or folder".into(),
        io::ErrorKind::PermissionDenied => "permission denied".into(),
        io::ErrorKind::StorageFull => "the disk is full".into(),
        io::ErrorKind::IsADirectory => "it is a folder".into(),
        io::ErrorKind::AlreadyExists => "it exists already".into(),
        _ => error.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_pipe_is_no_failure() {
        let error = io::Error::from(io::ErrorKind::BrokenPipe);
        assert_eq!(Failure::writing("standard output", &error).code(), 0);
    }

    #[test]
    fn full_disk_is_named() {
        let error = io::Error::from(io::ErrorKind::StorageFull);
        let failure = Failure::writing("`a.png`", &error);
        assert_eq!(failure.code(), 1);
        assert_eq!(
            failure.to_string(),
            "cannot write `a.png`: the disk is full"
        );
    }
}
