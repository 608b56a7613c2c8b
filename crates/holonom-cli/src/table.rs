//! Plain tables on a terminal.

/// Rows of cells under a header, columns as wide as their widest cell; the first column to the left, numbers to the right.
pub fn table(header: &[&str], rows: &[Vec<String>]) -> String {
    let width = |k: usize| rows.iter().map(|row| row[k].chars().count()).chain([header[k].chars().count()]).max().unwrap_or(0);
    let widths: Vec<usize> = (0..header.len()).map(width).collect();
    let line = |cells: Vec<&str>| {
        let cells = cells.iter().zip(&widths).enumerate().map(|(k, (cell, &width))| {
            let padding = " ".repeat(width - cell.chars().count());
            if k == 0 { format!("{cell}{padding}") } else { format!("{padding}{cell}") }
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_string()
    };
    let rule = widths.iter().map(|&width| "─".repeat(width)).collect::<Vec<_>>().join("  ");
    let body = rows.iter().map(|row| line(row.iter().map(String::as_str).collect()));
    [line(header.to_vec()), rule].into_iter().chain(body).collect::<Vec<_>>().join("\n")
}

/// Names and values, one a line; the further lines of a value under its first.
pub fn list(items: &[(&str, String)]) -> String {
    let width = items.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    items
        .iter()
        .map(|(name, value)| format!("  {name:width$}  {}", value.replace('\n', &format!("\n{:width$}    ", ""))))
        .collect::<Vec<_>>()
        .join("\n")
}

/// A number short enough for a table.
pub fn short(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if (1e-3..1e5).contains(&size) => {
            let text = format!("{value:.6}");
            text.trim_end_matches('0').trim_end_matches('.').to_string()
        }
        _ => format!("{value:.2e}"),
    }
}

/// A measured number: three figures, or all of those before the point.
pub fn measured(value: f64) -> String {
    let decimals = 2 - value.abs().max(1e-3).log10().floor() as i32;
    format!("{value:.*}", decimals.max(0) as usize)
}
