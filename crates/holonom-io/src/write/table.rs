//! A table of results with words among the numbers.

use super::csv_number;

/// Columns of equal length, by name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Headings and cells, in order.
    pub columns: Vec<(String, Cells)>,
}

/// The cells of a column; `None` where there is nothing.
#[derive(Clone, Debug, PartialEq)]
pub enum Cells {
    /// Counts and other whole numbers.
    Whole(Vec<Option<i64>>),
    /// Other numbers, whose text reads back to the same bits.
    Numbers(Vec<Option<f64>>),
    /// Names and other words.
    Words(Vec<Option<String>>),
}

impl Cells {
    /// Number of cells.
    pub fn len(&self) -> usize {
        match self {
            Self::Whole(cells) => cells.len(),
            Self::Numbers(cells) => cells.len(),
            Self::Words(cells) => cells.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A cell as text that reads back to the same bits; empty where there is nothing.
    pub fn text(&self, row: usize) -> String {
        match self {
            Self::Whole(cells) => cells[row].map_or(String::new(), |cell| cell.to_string()),
            Self::Numbers(cells) => cells[row].map_or(String::new(), csv_number),
            Self::Words(cells) => cells[row].clone().unwrap_or_default(),
        }
    }

    /// Appends a cell from its text; says whether it is one of this kind.
    pub fn push_text(&mut self, text: &str) -> bool {
        fn read<T: std::str::FromStr>(text: &str, cells: &mut Vec<Option<T>>) -> bool {
            let cell = text.parse().ok();
            let is_right = cell.is_some() || text.is_empty();
            cells.push(cell.filter(|_| !text.is_empty()));
            is_right
        }
        match self {
            Self::Whole(cells) => read(text, cells),
            Self::Numbers(cells) => read(text, cells),
            Self::Words(cells) => read(text, cells),
        }
    }
}

impl Table {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |(_, cells)| cells.len())
    }
}
