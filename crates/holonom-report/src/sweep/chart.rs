//! The frame of a plot as SVG: axes, ticks and their lines. Colours follow the style sheet, so that plots are light or dark with the page.

use std::io;

use super::axis::Axis;
use crate::escape::html;

/// Size of a plot in its own units, and of the field that the axes enclose.
pub const WIDTH: f64 = 460.0;
pub const HEIGHT: f64 = 270.0;
pub const LEFT: f64 = 66.0;
pub const RIGHT: f64 = 446.0;
pub const TOP: f64 = 10.0;
pub const BOTTOM: f64 = 222.0;

/// Begins a plot.
pub fn begin(label: &str, out: &mut dyn io::Write) -> io::Result<()> {
    writeln!(out, r#"<svg class="chart" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{}">"#, html(label))
}

/// Ends a plot.
pub fn end(out: &mut dyn io::Write) -> io::Result<()> {
    writeln!(out, "</svg>")
}

/// A place in the field, by its shares from the left and from the bottom.
pub fn place(x: f64, y: f64) -> (f64, f64) {
    (LEFT + x * (RIGHT - LEFT), BOTTOM - y * (BOTTOM - TOP))
}

/// Ticks with lines across the field, and the name of the axis at the bottom.
pub fn axes(x: &Axis, name: &str, y: &Axis, out: &mut dyn io::Write) -> io::Result<()> {
    for (share, label) in y.ticks() {
        let at = place(0.0, share).1;
        writeln!(out, r#"<line class="grid" x1="{LEFT}" x2="{RIGHT}" y1="{at:.1}" y2="{at:.1}"/>"#)?;
        left_tick((LEFT, at), &label, out)?;
    }
    for (share, label) in x.ticks() {
        let at = place(share, 0.0).0;
        writeln!(out, r#"<line class="grid" x1="{at:.1}" x2="{at:.1}" y1="{TOP}" y2="{BOTTOM}"/>"#)?;
        bottom_tick(at, &label, out)?;
    }
    name_below(name, out)
}

/// A label to the left of a place at the edge of the field.
pub fn left_tick((x, y): (f64, f64), label: &str, out: &mut dyn io::Write) -> io::Result<()> {
    writeln!(out, r#"<text x="{:.1}" y="{:.1}" text-anchor="end">{}</text>"#, x - 7.0, y + 4.0, html(label))
}

/// A label below the field.
pub fn bottom_tick(at: f64, label: &str, out: &mut dyn io::Write) -> io::Result<()> {
    writeln!(out, r#"<text x="{at:.1}" y="{:.1}" text-anchor="middle">{}</text>"#, BOTTOM + 17.0, html(label))
}

/// What the axis at the bottom shows.
pub fn name_below(name: &str, out: &mut dyn io::Write) -> io::Result<()> {
    let middle = 0.5 * (LEFT + RIGHT);
    writeln!(out, r#"<text class="name" x="{middle:.1}" y="{:.1}" text-anchor="middle">{}</text>"#, BOTTOM + 37.0, html(name))
}

/// A cross of a run that did not complete, with what is said when the pointer rests on it.
pub fn cross((x, y): (f64, f64), told: &str, out: &mut dyn io::Write) -> io::Result<()> {
    let path = format!("M{:.1} {:.1}l7 7m0 -7l-7 7", x - 3.5, y - 3.5);
    writeln!(out, r#"<path class="failed" d="{path}"><title>{}</title></path>"#, html(told))
}
