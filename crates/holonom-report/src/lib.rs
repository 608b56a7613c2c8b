//! The HTML report of one or several runs, of a sweep, of a search for the largest steps, and of modes: one file that needs no network and opens from disk.
//!
//! The page is made of three parts. What can be read without a script (title, key figures, summary, model file) is written as
//! HTML here. The numbers go in as JSON. The viewer, bundled by `build.rs` from `viewer/`, turns them into the moving
//! mechanism and the plots; without the feature `viewer` the page consists of the first part alone.

mod answers;
mod base64;
mod comparison;
mod data;
pub mod digits;
mod escape;
mod figures;
mod format;
mod live;
mod modes;
mod outcome;
mod page;
mod provenance;
mod stability;
mod summary;
mod sweep;
#[cfg(test)]
mod tests;
mod thin;
mod works;

use holonom::record::{Recording, Scene};
use std::io;

pub use answers::{Answer, answers};
pub use live::{Frames, LIVE};
pub use modes::{ModeShape, ModesReport};
pub use outcome::ended;
pub use stability::{Search, StabilityReport};
pub use sweep::{SweepColumn, SweepKey, SweepReport, SweepRun};
pub use works::{Work, largest as largest_works};

/// What is known of one run.
pub struct Run<'a> {
    /// How the run is called in legends and table headings; unique within a report.
    pub label: &'a str,
    /// What the plots and the viewer show.
    pub recording: &'a Recording,
    /// How the viewer draws the mechanism.
    pub scene: &'a Scene,
    /// Content of `summary.json`.
    pub summary: &'a serde_json::Value,
}

/// A page about one run, or about several that are compared.
pub struct Report<'a> {
    /// Heading of the page, as plain text.
    pub title: &'a str,
    /// The model file, shown at the bottom.
    pub model_text: &'a str,
    /// One run, or those that are compared.
    pub runs: &'a [Run<'a>],
    /// Columns that are plotted first, in place of those that are shown otherwise.
    pub columns: &'a [String],
}

impl Report<'_> {
    /// Writes the page.
    pub fn write(&self, out: &mut dyn io::Write) -> io::Result<()> {
        page::write(self, out)
    }
}
