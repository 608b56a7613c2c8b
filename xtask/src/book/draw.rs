//! Draws a figure as SVG: curves labelled at their ends, colours that colour-blind readers tell apart.

use std::fmt::Display;
use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::figure::{Axis, Curve, Figure, Scale};
use super::results::Results;

/// What is drawn: axes and curves with labels. Curves of single runs have their points marked.
pub struct Picture<'a> {
    pub title: &'a str,
    pub x: &'a Axis,
    pub y: &'a Axis,
    pub curves: Vec<Line<'a>>,
    pub marked: bool,
}

/// A curve in the axes' units.
pub struct Line<'a> {
    pub label: &'a str,
    pub points: Vec<(f64, f64)>,
}

/// Okabe and Ito's palette without its yellow, which is too light for lines.
const PALETTE: [RGBColor; 7] = [
    RGBColor(0, 0, 0),
    RGBColor(213, 94, 0),
    RGBColor(0, 114, 178),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

/// The backend rounds to whole units: there are this many in a pixel.
const UNITS: i32 = 4;
const WIDTH: i32 = 900;
const HEIGHT: i32 = 440;

/// Room for the labels at the right, pixels.
const LABELS: i32 = 225;

/// Distance of labels from each other, pixels.
const LINE: i32 = 20;

const FONT: i32 = 15;

/// A logarithmic axis that ends at less than this times its start is marked between decades too.
const FEW_DECADES: f64 = 300.0;

/// Most points of a curve.
const MOST_POINTS: usize = 420;

/// A curve's label: where its curve ends, in units, and its colour.
struct Label<'a> {
    text: &'a str,
    end: (i32, i32),
    colour: RGBColor,
}

/// The figure's picture.
pub fn svg(figure: &Figure, results: &Results) -> Result<String, String> {
    let line = |curve: &Curve| Line { label: curve.label, points: (figure.points)(results, curve) };
    let curves = figure.curves.iter().map(line).collect();
    let picture = Picture { title: figure.title, x: &figure.x, y: &figure.y, curves, marked: false };
    picture.svg().map_err(|fault| format!("figure `{}`: {fault}", figure.name))
}

impl Picture<'_> {
    pub fn svg(&self) -> Result<String, String> {
        let mut text = String::new();
        draw(self, &mut text)?;
        let [width, height] = [WIDTH, HEIGHT].map(|size| size * UNITS);
        Ok(text.replacen(&format!("width=\"{width}\" height=\"{height}\""), &format!("width=\"{WIDTH}\" height=\"{HEIGHT}\""), 1))
    }
}

fn draw(picture: &Picture<'_>, text: &mut String) -> Result<(), String> {
    let size = ((WIDTH * UNITS) as u32, (HEIGHT * UNITS) as u32);
    let area = SVGBackend::with_string(text, size).into_drawing_area();
    area.fill(&WHITE).map_err(fault)?;
    let mut chart = ChartBuilder::on(&area)
        .caption(picture.title, ("sans-serif", (FONT + 3) * UNITS))
        .margin(10 * UNITS)
        .margin_right(LABELS * UNITS)
        .x_label_area_size(48 * UNITS)
        .y_label_area_size(72 * UNITS)
        .build_cartesian_2d(range(picture.x), range(picture.y))
        .map_err(fault)?;
    chart
        .configure_mesh()
        .x_desc(picture.x.label)
        .y_desc(picture.y.label)
        .x_label_formatter(&|value| number(*value, picture.x))
        .y_label_formatter(&|value| number(*value, picture.y))
        .label_style(("sans-serif", FONT * UNITS))
        .axis_style(BLACK.stroke_width(UNITS as u32))
        .bold_line_style(RGBColor(225, 225, 225).stroke_width(UNITS as u32))
        .light_line_style(TRANSPARENT)
        .set_all_tick_mark_size(4 * UNITS)
        .draw()
        .map_err(fault)?;
    let mut labels = Vec::new();
    for (curve, colour) in picture.curves.iter().zip(PALETTE) {
        let points = inside(&curve.points, picture.x, picture.y)?;
        let Some(end) = points.iter().max_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
        labels.push(Label { text: curve.label, end: chart.backend_coord(end), colour });
        if picture.marked {
            let marks = points.iter().map(|&point| Circle::new(point, 4 * UNITS, colour.filled()));
            chart.draw_series(marks).map_err(fault)?;
        }
        chart.draw_series(LineSeries::new(points, colour.stroke_width(2 * UNITS as u32))).map_err(fault)?;
    }
    write_labels(&area, labels)?;
    area.present().map_err(fault)
}

fn fault(error: impl Display) -> String {
    error.to_string()
}

/// Labels beside the ends of their curves, in their order and without overlaps, each tied to its end by a line.
fn write_labels(area: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>, mut labels: Vec<Label<'_>>) -> Result<(), String> {
    labels.sort_by_key(|label| label.end.1);
    let heights = apart(&labels.iter().map(|label| label.end.1).collect::<Vec<_>>());
    let left = (WIDTH - LABELS) * UNITS;
    for (label, height) in labels.iter().zip(heights) {
        let colour = dark(label.colour);
        let style = ("sans-serif", FONT * UNITS).into_text_style(area).color(&colour).pos(Pos::new(HPos::Left, VPos::Center));
        let tie = vec![(label.end.0.max(left - UNITS), label.end.1), (left + 12 * UNITS, height), (left + 16 * UNITS, height)];
        if label.end.0 >= left - 2 * UNITS {
            area.draw(&PathElement::new(tie, label.colour.stroke_width(UNITS as u32))).map_err(fault)?;
        }
        area.draw(&Text::new(label.text, (left + 20 * UNITS, height), style)).map_err(fault)?;
    }
    Ok(())
}

/// A line's colour as it is legible in letters.
fn dark(RGBColor(red, green, blue): RGBColor) -> RGBColor {
    let [red, green, blue] = [red, green, blue].map(|part| part / 4 * 3);
    RGBColor(red, green, blue)
}

/// Sorted heights moved as little as needed for [`LINE`] between them and for all to be in the picture.
fn apart(heights: &[i32]) -> Vec<i32> {
    let mut moved = heights.to_vec();
    let lowest = (HEIGHT - LINE) * UNITS;
    for _ in 0..100 {
        for i in 1..moved.len() {
            let overlap = LINE * UNITS - (moved[i] - moved[i - 1]);
            if overlap > 0 {
                moved[i - 1] -= (overlap + 1) / 2;
                moved[i] += (overlap + 1) / 2;
            }
        }
        moved.iter_mut().for_each(|height| *height = (*height).min(lowest));
    }
    moved
}

/// Points as the axes count them, and not more than can be seen. A logarithmic axis has no place for what is below its
/// start, such as zeros; anything else beyond an axis is a fault of the figure.
fn inside(points: &[(f64, f64)], x: &Axis, y: &Axis) -> Result<Vec<(f64, f64)>, String> {
    let times = x.from * (1.0 - 1e-9)..=x.to * (1.0 + 1e-9);
    let seen = points.iter().filter(|(at, value)| times.contains(at) && (y.scale == Scale::Linear || *value >= y.from));
    let seen: Vec<_> = seen.copied().collect();
    if let Some((at, value)) = seen.iter().find(|(_, value)| !(y.from..=y.to).contains(value)) {
        return Err(format!("the vertical axis has no place for {value:e} at {at}"));
    }
    let stride = seen.len().div_ceil(MOST_POINTS).max(1);
    Ok(seen.iter().step_by(stride).map(|(at, value)| (scaled(*at, x.scale), scaled(*value, y.scale))).collect())
}

fn scaled(value: f64, scale: Scale) -> f64 {
    if scale == Scale::Log { value.log10() } else { value }
}

/// An axis as it counts, with its marks.
struct Marked {
    ends: RangedCoordf64,
    marks: Vec<f64>,
}

impl Ranged for Marked {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.ends.map(value, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.marks.clone()
    }

    fn range(&self) -> Range<f64> {
        self.ends.range()
    }
}

fn range(axis: &Axis) -> Marked {
    let [from, to] = [axis.from, axis.to].map(|end| scaled(end, axis.scale));
    let marks = if axis.scale == Scale::Log { decades(from, to, axis.to / axis.from < FEW_DECADES) } else { steps(from, to) };
    Marked { ends: (from..to).into(), marks }
}

/// Marks of a logarithmic axis: whole decades, with 2 and 5 between where they are few.
fn decades(from: f64, to: f64, few: bool) -> Vec<f64> {
    let every = ((to - from) / 8.0).ceil().max(1.0) as i32;
    let between: &[f64] = if few { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let whole = (from.floor() as i32..=to.ceil() as i32).filter(|decade| decade % every == 0);
    let marks = whole.flat_map(|decade| between.iter().map(move |digit| f64::from(decade) + digit.log10()));
    marks.filter(|mark| (from - 1e-9..=to + 1e-9).contains(mark)).collect()
}

/// Marks of a linear axis: multiples of 1, 2 or 5, about seven.
fn steps(from: f64, to: f64) -> Vec<f64> {
    let rough = (to - from) / 7.0;
    let decade = 10_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|digit| digit * decade).into_iter().find(|step| *step >= rough).unwrap_or(rough);
    ((from / step).ceil() as i32..=(to / step + 1e-9).floor() as i32).map(|i| f64::from(i) * step).collect()
}

fn number(value: f64, axis: &Axis) -> String {
    let rounded = |value: f64| format!("{}", (value * 1e4).round() / 1e4 + 0.0);
    match axis.scale {
        Scale::Linear => rounded(value),
        Scale::Log if axis.to / axis.from < FEW_DECADES => rounded(10_f64.powf(value)),
        Scale::Log => format!("1e{}", value.round()),
    }
}
