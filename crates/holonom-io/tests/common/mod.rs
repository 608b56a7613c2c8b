//! The gallery, for tests that run it.

use holonom::model::Model;
use holonom_io::Source;

/// A model of the gallery.
pub fn example(name: &str) -> Model {
    let path = format!("{}/../../examples/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let source = Source::read(name, &std::fs::read(path).unwrap()).unwrap_or_else(|message| panic!("{message}"));
    source.model().unwrap_or_else(|message| panic!("{message}"))
}
