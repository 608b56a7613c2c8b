//! Plain tables on a terminal.

use holonom_report::digits::{DIGITS, between, rounded, without_round_off};
use unicode_width::UnicodeWidthStr;

/// Characters of a line that a terminal has at least.
const LEAST: usize = 40;

/// Characters of a line of the terminal; another program, or a file, reads lines of any length.
fn room() -> usize {
    terminal_size::terminal_size_of(std::io::stdout()).map_or(usize::MAX, |(width, _)| usize::from(width.0).max(LEAST))
}

/// Between two columns.
const GAP: &str = "  ";

/// Rows of cells under a header, columns as wide as their widest cell; the first column to the left, numbers to the right. Where a line has no room for all
/// columns, the others follow below, beside the first again.
pub fn table(header: &[&str], rows: &[Vec<String>]) -> String {
    table_within(room(), header, rows)
}

fn table_within(room: usize, header: &[&str], rows: &[Vec<String>]) -> String {
    let width = |k: usize| rows.iter().map(|row| row[k].width()).chain([header[k].width()]).max().unwrap_or(0);
    let widths: Vec<usize> = (0..header.len()).map(width).collect();
    let line = |cells: &dyn Fn(usize) -> String, columns: &[usize]| {
        let cells = columns.iter().map(|&k| {
            let padding = " ".repeat(widths[k] - cells(k).width());
            if k == 0 { cells(k) + &padding } else { padding + &cells(k) }
        });
        cells.collect::<Vec<_>>().join(GAP).trim_end().to_string()
    };
    let block = |columns: Vec<usize>| {
        let rule = columns.iter().map(|&k| "─".repeat(widths[k])).collect::<Vec<_>>().join(GAP);
        let body = rows.iter().map(|row| line(&|k| row[k].clone(), &columns));
        [line(&|k| header[k].to_string(), &columns), rule].into_iter().chain(body).collect::<Vec<_>>().join("\n")
    };
    blocks(room, &widths).into_iter().map(block).collect::<Vec<_>>().join("\n\n")
}

/// Which columns of these widths stand beside each other, always with the first.
fn blocks(room: usize, widths: &[usize]) -> Vec<Vec<usize>> {
    let mut blocks = vec![vec![0]];
    let mut used = widths[0];
    for (k, width) in widths.iter().enumerate().skip(1) {
        if used + GAP.len() + width > room && blocks[blocks.len() - 1].len() > 1 {
            blocks.push(vec![0]);
            used = widths[0];
        }
        used += GAP.len() + width;
        blocks.last_mut().expect("there is one").push(k);
    }
    blocks
}

/// Names and values, one a line; the further lines of a value under its first, and what a line has no room for a little to the right below it.
pub fn list(items: &[(&str, String)]) -> String {
    let width = items.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    let (margin, room) = (format!("\n{:width$}    ", ""), room().saturating_sub(width + 4).max(LEAST / 2));
    let item = |(name, value): &(&str, String)| {
        let lines = value.split('\n').map(|line| wrapped(line, room).join(&format!("{margin}  ")));
        format!("  {name:width$}  {}", lines.collect::<Vec<_>>().join(&margin))
    };
    items.iter().map(item).collect::<Vec<_>>().join("\n")
}

/// A line in parts: the first of at most so many characters, and the others, which are moved to the right by two, of two less. They end behind a comma
/// or a colon if one is near their end, else before a word.
fn wrapped(line: &str, room: usize) -> Vec<&str> {
    let mut parts = Vec::new();
    let (mut rest, mut room) = (line, room);
    while let Some((end, _)) = rest.char_indices().nth(room) {
        // A part may end before the blank that follows its last character.
        let blanks: Vec<usize> = rest.match_indices(' ').map(|(at, _)| at).take_while(|at| *at <= end).collect();
        let is_pause = |at: &usize| rest[..*at].ends_with([',', ':']) && 10 * at >= 7 * end;
        let at = blanks.iter().copied().rev().find(is_pause).or(blanks.last().copied()).or_else(|| rest.find(' '));
        let Some(at) = at else { break };
        parts.push(rest[..at].trim_end());
        rest = rest[at..].trim_start();
        if parts.len() == 1 {
            room -= 2;
        }
    }
    parts.push(rest);
    parts
}

/// Figures of a number that is too large for as many places behind the point as others have.
const LARGE_DIGITS: usize = 9;

/// A number short enough for a table.
pub fn short(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if (1e-3..1e5).contains(&size) => {
            let text = format!("{value:.6}");
            text.trim_end_matches('0').trim_end_matches('.').to_string()
        }
        size if size >= 1e5 => significant(value, LARGE_DIGITS),
        _ => format!("{value:.2e}"),
    }
}

/// A number of an answer: five figures.
pub fn figures(value: f64) -> String {
    significant(value, DIGITS)
}

fn significant(value: f64, figures: usize) -> String {
    let text = format!("{value:.*e}", figures - 1);
    let rounded = rounded(value, figures);
    match (rounded.abs(), text.split_once('e')) {
        (size, Some((mantissa, exponent))) if size > 0.0 && !(1e-3..1e7).contains(&size) => {
            format!("{}e{exponent}", mantissa.trim_end_matches('0').trim_end_matches('.'))
        }
        _ => format!("{rounded}"),
    }
}

/// A number of an answer that is zero where it is round-off beside the largest of its like.
pub fn figures_beside(value: f64, largest: f64) -> String {
    figures(without_round_off(value, largest))
}

/// A number between two others.
pub fn figures_between(value: f64, ends: [f64; 2]) -> String {
    let (value, digits) = between(value, ends);
    significant(value, digits)
}

/// Degrees of freedom, counted.
pub fn freedom(count: u64) -> String {
    format!("{count} degree{} of freedom", if count == 1 { "" } else { "s" })
}

/// A measured number: three figures, or all of those before the point.
pub fn measured(value: f64) -> String {
    let decimals = 2 - value.abs().max(1e-3).log10().floor() as i32;
    format!("{value:.*}", decimals.max(0) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_cut_where_one_would_pause() {
        let cases = [
            ("short", 10, vec!["short"]),
            ("4 coordinates, 3 rows of rank 3", 20, vec!["4 coordinates,", "3 rows of rank 3"]),
            ("one two three four five", 9, vec!["one two", "three", "four", "five"]),
            ("one, two three four", 14, vec!["one, two three", "four"]),
            ("αβγ δεζ ηθι", 7, vec!["αβγ δεζ", "ηθι"]),
            ("averylongname and more", 5, vec!["averylongname", "and", "more"]),
            ("averylongname", 5, vec!["averylongname"]),
        ];
        for (line, room, parts) in cases {
            assert_eq!(wrapped(line, room), parts, "{line}");
        }
    }

    #[test]
    fn columns_without_room_follow_below() {
        let row = |cells: [&str; 4]| cells.map(String::from).to_vec();
        let wide = "w".repeat(40);
        let told = table_within(80, &["run", "a", &wide, "b"], &[row(["one", "1", &wide, "3"]), row(["other", "2", "22", "4"])]);
        assert!(!told.contains("\n\n"), "{told}");
        let told = table_within(80, &["run", &wide, &wide, "b"], &[row(["one", "1", "2", "3"])]);
        let blocks: Vec<Vec<&str>> = told.split("\n\n").map(|block| block.lines().collect()).collect();
        assert_eq!(blocks.len(), 2, "{told}");
        assert!(blocks[0][2].starts_with("one ") && blocks[0][2].ends_with(" 1"), "{told}");
        assert_eq!(blocks[1][2].split_whitespace().collect::<Vec<_>>(), ["one", "2", "3"], "{told}");
        assert!(told.lines().all(|line| line.chars().count() <= 80), "{told}");
        let told = table_within(80, &["run", "a"], &[vec!["箱の列".into(), "1".into()], vec!["boxes".into(), "2".into()]]);
        assert!(told.ends_with("箱の列  1\nboxes   2"), "a character of East Asia is two columns wide: {told}");
    }

    #[test]
    fn large_numbers_differ_where_small_ones_do() {
        let cases = [(-57_501.068_266_4, "-57501.068266"), (-118_236.500_21, "-118236.5"), (3.456_789_012_34e10, "3.45678901e10")];
        for (value, text) in cases.into_iter().chain([(1e7, "1e7"), (1.234e-9, "1.23e-9"), (f64::INFINITY, "inf"), (f64::NAN, "NaN")]) {
            assert_eq!(short(value), text);
        }
    }

    #[test]
    fn answers_have_five_figures() {
        let cases =
            [(0.0, "0"), (2.726_63, "2.7266"), (-1.234_56e-4, "-1.2346e-4"), (49.88345, "49.883"), (108_959.4, "108960"), (2e8, "2e8")];
        for (value, text) in cases.into_iter().chain([(0.001_234_56, "0.0012346"), (f64::NAN, "NaN")]) {
            assert_eq!(figures(value), text);
        }
        assert_eq!([10_000.03, 1e4].map(|value| figures_between(value, [9_999.97, 10_000.03])), ["10000.03", "10000"]);
        assert_eq!([2e-14, 70.270_63].map(|value| figures_between(value, [-0.963_66, 70.270_63])), ["0", "70.271"]);
        assert_eq!([figures_beside(2e-14, 10.0), figures_beside(2e-11, 10.0)], ["0", "2e-11"]);
    }
}
