//! Where the keys and values of a description stand in its file.

use std::collections::HashMap;
use std::ops::Range;

/// Bytes of keys and values by path.
#[derive(Clone, Debug, Default)]
pub(super) struct Places {
    values: HashMap<String, Range<usize>>,
    keys: HashMap<String, Range<usize>>,
}

impl Places {
    pub(super) fn add_value(&mut self, path: &str, bytes: Range<usize>) {
        self.values.insert(path.to_string(), bytes);
    }

    pub(super) fn add_key(&mut self, path: &str, bytes: Range<usize>) {
        self.keys.insert(path.to_string(), bytes);
    }

    /// Forgets what has been replaced from outside the file.
    pub(super) fn forget(&mut self, path: &str) {
        self.values.remove(path);
        self.keys.remove(path);
    }

    /// The bytes of a path, or of the nearest thing around it that is in the file.
    pub(super) fn find(&self, path: &str, on_key: bool) -> Option<Range<usize>> {
        let mut path = path;
        let mut first = if on_key { &self.keys } else { &self.values };
        loop {
            // What is missing in a table is shown at the table's name.
            if let Some(bytes) = first.get(path).or_else(|| self.keys.get(path)).or_else(|| self.values.get(path)) {
                return Some(bytes.clone());
            }
            path = parent(path)?;
            first = &self.keys;
        }
    }
}

/// The path without its last part.
fn parent(path: &str) -> Option<&str> {
    let mut quoted = false;
    let mut cut = None;
    for (at, c) in path.char_indices() {
        match c {
            '"' => quoted = !quoted,
            '.' | '[' if !quoted => cut = Some(at),
            _ => (),
        }
    }
    cut.map(|at| &path[..at])
}

#[cfg(test)]
mod tests {
    use super::parent;

    #[test]
    fn paths_end_at_dots_and_brackets_outside_quotes() {
        assert_eq!(parent("point.m1.position[0]"), Some("point.m1.position"));
        assert_eq!(parent("point.\"a.b\""), Some("point"));
        assert_eq!(parent("point"), None);
    }
}
