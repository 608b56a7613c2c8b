//! The chapter: its generated tables stand between `<!-- table: NAME -->` and `<!-- end -->`.

use std::path::{Path, PathBuf};

/// Two figures agree within this share of the larger one.
const AGREE: f64 = 0.01;

/// Below this a figure is round-off.
pub const ROUND_OFF: f64 = 1e-10;

const END: &str = "<!-- end -->";

pub struct Chapter {
    path: PathBuf,
    text: String,
}

impl Chapter {
    /// Reads a chapter by its file name.
    pub fn read(root: &Path, file: &str) -> Result<Self, String> {
        let path = root.join("docs").join(file);
        let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        Ok(Self { path, text })
    }

    pub fn write(&self) -> Result<(), String> {
        std::fs::write(&self.path, &self.text).map_err(|error| format!("{}: {error}", self.path.display()))
    }

    /// Whether a figure is there, and in the text.
    pub fn shows(&self, figure: &str) -> Result<(), String> {
        let file = format!("figures/{figure}.svg");
        if !self.text.contains(&format!("({file})")) {
            return Err(format!("the chapter does not show {file}"));
        }
        match self.path.with_file_name(&file).is_file() {
            true => Ok(()),
            false => Err(format!("docs/{file} is not there")),
        }
    }

    /// Puts a table in its place.
    pub fn fill(&mut self, name: &str, table: &str) -> Result<(), String> {
        let (start, end) = self.place(name)?;
        self.text.replace_range(start..end, &format!("\n{table}"));
        Ok(())
    }

    /// Whether the chapter's table is this one, up to [`AGREE`].
    pub fn agrees(&self, name: &str, table: &str) -> Result<(), String> {
        let (start, end) = self.place(name)?;
        let [written, measured] = [&self.text[start..end], table].map(cells);
        let differing = written.iter().zip(&measured).find(|(old, new)| !agree(old, new));
        match differing {
            Some((old, new)) => Err(format!("table `{name}` says {old}, measured now: {new}")),
            None if written.len() != measured.len() => Err(format!("table `{name}` is out of date")),
            None => Ok(()),
        }
    }

    /// Where a table's text starts and ends.
    fn place(&self, name: &str) -> Result<(usize, usize), String> {
        let marker = format!("<!-- table: {name} -->");
        let start = self.text.find(&marker).ok_or_else(|| format!("the chapter has no `{marker}`"))? + marker.len();
        let length = self.text[start..].find(END).ok_or_else(|| format!("the chapter has no `{END}` after `{marker}`"))?;
        Ok((start, start + length))
    }
}

fn cells(table: &str) -> Vec<&str> {
    table.lines().flat_map(|line| line.split('|')).map(str::trim).filter(|cell| !cell.is_empty()).collect()
}

/// Whether two cells have the same words, and figures that agree.
fn agree(old: &str, new: &str) -> bool {
    let [old, new] = [old, new].map(|cell| cell.split_whitespace().collect::<Vec<_>>());
    old.len() == new.len() && old.iter().zip(&new).all(|(old, new)| old == new || close(old, new))
}

fn close(old: &str, new: &str) -> bool {
    match (old.parse::<f64>(), new.parse::<f64>()) {
        (Ok(old), Ok(new)) => {
            let size = old.abs().max(new.abs());
            size < ROUND_OFF || (old - new).abs() <= AGREE * size
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::agree;

    #[test]
    fn cells_agree_to_one_percent_or_in_round_off() {
        assert!(agree("0.0142", "0.01421"));
        assert!(agree("3e-13", "8e-15"));
        assert!(agree("off at 4.95 s", "off at 4.975 s"));
        assert!(!agree("0.0142", "0.0145"));
        assert!(!agree("round-off", "1e-9"));
        assert!(!agree("off at 4.95 s", "completes"));
    }
}
