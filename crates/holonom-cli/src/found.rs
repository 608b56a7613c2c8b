//! What an analysis has found, for programs and for people.

use serde_json::Value;

/// What an analysis has found.
pub struct Found {
    /// As `--json` prints it.
    pub value: Value,
    /// As the command prints it.
    pub text: String,
}
