//! What can go wrong in the command, and the exit status it ends with.

use std::io::ErrorKind;
use std::path::PathBuf;
use std::process::ExitCode;

/// Exit status of a run that stopped before its end, of a comparison that was interrupted, and of a sweep that was interrupted or of which no
/// run completed; everything up to there is written.
pub const STOPPED: u8 = 3;

/// Why a command did not do what it was asked to.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// A bad model; the text lists every fault with its place and cure.
    #[error("{0}")]
    Model(String),
    #[error("error: {message}\n  cure: {cure}")]
    /// Something that cannot be done as it was asked for.
    Usage {
        /// What is wrong.
        message: String,
        /// What to do about it.
        cure: String,
    },
    #[error("error: cannot read {path}: {why}\n  cure: {cure}", path = .path.display(), why = if .source.kind() == ErrorKind::IsADirectory { "it is a folder" } else { "there is no such file or folder" })]
    /// A file or a folder that is not there, or a folder in place of a file.
    NotThere {
        /// Which one.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
        /// What to give in its place.
        cure: &'static str,
    },
    #[error("error: cannot {doing} {path}: {source}", path = .path.display())]
    /// A file that cannot be read or written.
    File {
        /// `read`, `write`, …
        doing: &'static str,
        /// Which file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}

impl Failure {
    /// 2 for a bad model or bad use, 4 for a file that cannot be read or written.
    pub fn exit_code(&self) -> ExitCode {
        match self {
            Self::Model(_) | Self::Usage { .. } => ExitCode::from(2),
            Self::NotThere { .. } | Self::File { .. } => ExitCode::from(4),
        }
    }

    /// A file that cannot be read, with the cure for one that is not there or is none.
    pub fn unread(path: impl Into<PathBuf>, source: std::io::Error, cure: &'static str) -> Self {
        match source.kind() {
            ErrorKind::NotFound | ErrorKind::IsADirectory => Self::NotThere { path: path.into(), source, cure },
            _ => Self::File { doing: "read", path: path.into(), source },
        }
    }

    /// A wrong use with its cure.
    pub fn usage(message: impl Into<String>, cure: impl Into<String>) -> Self {
        Self::Usage { message: message.into(), cure: cure.into() }
    }
}
