//! The page about the largest steps: a bar for each method on a logarithmic axis.

use crate::escape::html;
use crate::{format, page, provenance};
use std::io;

/// What the search found for one method; steps in s.
pub struct Search<'a> {
    /// Name of the method.
    pub method: &'a str,
    /// Largest step that completes; zero when none did.
    pub completes: f64,
    /// Smallest step that fails; none when every step up to the limit completed.
    pub fails: Option<f64>,
    /// Simulations that the search took.
    pub runs: usize,
}

/// A page about the largest step with which each method completes a run.
pub struct StabilityReport<'a> {
    /// Heading of the page, as plain text.
    pub title: &'a str,
    /// The model file, shown at the bottom.
    pub model_text: &'a str,
    /// What was run, as in `summary.json`.
    pub provenance: &'a serde_json::Value,
    /// Length of the run, s.
    pub end: f64,
    /// Step the search began with, s.
    pub first: f64,
    /// Largest step tried, s.
    pub limit: f64,
    /// The search ends when the step that fails is at most so many times the one that completes.
    pub ratio: f64,
    /// Drift over |E(0)| + |W| + 1 J beyond which a run counts as failed; a power of ten.
    pub exploded: f64,
    /// One for each method, in the order of the page.
    pub searches: &'a [Search<'a>],
}

impl StabilityReport<'_> {
    /// Writes the page.
    pub fn write(&self, out: &mut dyn io::Write) -> io::Result<()> {
        page::head(self.title, "", out)?;
        writeln!(out, "<header>\n<h1>{}</h1>\n<p class=\"method\">{}</p>\n</header>\n<main>", html(self.title), self.question())?;
        writeln!(out, "<section>\n<h2>Largest step that completes {} s</h2>", format::number(self.end))?;
        self.chart(out)?;
        writeln!(out, "<p class=\"note\">{}</p>\n</section>", self.explanation())?;
        provenance::write(&[(self.title, self.provenance)], out)?;
        page::model(self.model_text, out)?;
        writeln!(out, "</main>")?;
        page::end(out)
    }

    fn question(&self) -> String {
        let (first, limit) = (format::number(self.first), format::number(self.limit));
        let methods = match self.searches.len() {
            1 => "1 method".to_owned(),
            count => format!("{count} methods"),
        };
        let percent = format::number(100.0 * (self.ratio - 1.0));
        format!("{methods} · first step tried {first} s · limit of the search {limit} s · found to within {percent}\u{202f}%")
    }

    fn explanation(&self) -> String {
        format!(
            "A step completes when the run reaches its end and its energy never drifts by more than 10<sup>{:.0}</sup> times \
             |E(0)| + |W| + 1 J; no step is divided. An arrow stands where the limit of the search was reached: the largest step is at least \
             that. The axis is logarithmic.",
            self.exploded.log10()
        )
    }

    fn chart(&self, out: &mut dyn io::Write) -> io::Result<()> {
        let axis = Axis::of(self);
        let ticks: String = axis.ticks().iter().map(|(at, label)| format!(r#"<span style="left:{at:.2}%">{label}</span>"#)).collect();
        writeln!(
            out,
            r#"<div class="scroll"><table class="figures steps"><thead><tr><th scope="col">method</th><th class="bars"><div class="axis">{ticks}</div></th>
<th scope="col" class="number">completes<small>s</small></th><th scope="col" class="number">fails<small>s</small></th><th scope="col" class="number">runs<small>of the search</small></th></tr></thead><tbody>"#
        )?;
        for search in self.searches {
            self.row(search, &axis, out)?;
        }
        writeln!(out, "</tbody></table></div>")
    }

    fn row(&self, search: &Search, axis: &Axis, out: &mut dyn io::Write) -> io::Result<()> {
        let grid: String = axis.ticks().iter().map(|(at, _)| format!(r#"<i style="left:{at:.2}%"></i>"#)).collect();
        let completes = if search.completes > 0.0 { digits(search.completes) } else { "none".to_owned() };
        let fails = search.fails.map_or("–".to_owned(), digits);
        writeln!(
            out,
            r#"<tr><th scope="row">{}</th><td class="bars"><div class="track">{grid}{}</div></td><td class="number">{completes}</td><td class="number">{fails}</td><td class="number">{}</td></tr>"#,
            html(search.method),
            bar(search, axis),
            search.runs
        )
    }
}

/// The bar of a method with its value beside it.
fn bar(search: &Search, axis: &Axis) -> String {
    if search.completes <= 0.0 {
        let tried = search.fails.map_or(String::new(), |fails| format!(", down to {} s", digits(fails)));
        return format!(r#"<b class="none">no step completes{tried}</b>"#);
    }
    let (width, value) = (axis.place(search.completes), digits(search.completes));
    match search.fails {
        None => format!(r#"<span class="bar open" style="width:{width:.2}%"></span><b style="left:{width:.2}%">≥ {value} s</b>"#),
        Some(_) => format!(r#"<span class="bar" style="width:{width:.2}%"></span><b style="left:{width:.2}%">{value} s</b>"#),
    }
}

/// A logarithmic axis from a power of ten to the limit of the search, with room on the right for the values.
struct Axis {
    /// Exponents of ten at the ends.
    low: f64,
    high: f64,
}

/// Share of the width that the axis takes, %.
const WIDTH: f64 = 86.0;

/// Up to so many decades, 2 and 5 have their ticks too, where they can be written plainly.
const FEW_DECADES: f64 = 2.5;

impl Axis {
    fn of(report: &StabilityReport) -> Self {
        let steps = report.searches.iter().map(|search| search.completes).filter(|&step| step > 0.0);
        let (least, most) = steps.fold((report.first, report.limit), |(least, most), step| (least.min(step), most.max(step)));
        let high = most.log10();
        // A bar that ended at the left edge would not be seen.
        Self { low: (least.log10().min(high) - 0.1).floor(), high }
    }

    /// Distance from the left edge, %.
    fn place(&self, step: f64) -> f64 {
        WIDTH * (step.log10() - self.low) / (self.high - self.low)
    }

    /// Places and labels.
    fn ticks(&self) -> Vec<(f64, String)> {
        let few = self.high - self.low <= FEW_DECADES && 10f64.powf(self.low) >= PLAIN;
        let leading: &[f64] = if few { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let decades = self.low as i32..=self.high.floor() as i32;
        let steps = decades.flat_map(|exponent| leading.iter().map(move |lead| lead * 10f64.powi(exponent)));
        let within = steps.filter(|step| step.log10() <= self.high + 1e-9);
        within.map(|step| (self.place(step), tick_label(step))).collect()
    }
}

/// Below this, s, powers of ten are written as such.
const PLAIN: f64 = 0.99e-3;

fn tick_label(step: f64) -> String {
    if step >= PLAIN { format!("{} s", format::number(step)) } else { format!("10<sup>\u{2212}{:.0}</sup> s", -step.log10()) }
}

/// Three digits of a step.
fn digits(step: f64) -> String {
    match step.log10().floor() as i32 {
        -3 => format!("{step:.5}").trim_end_matches('0').to_owned(),
        _ => format::figure(step),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page(searches: &[Search]) -> String {
        let mut out = Vec::new();
        let report = StabilityReport {
            title: "A & B",
            model_text: "title = \"A\"",
            provenance: &serde_json::Value::Null,
            end: 20.0,
            first: 0.025,
            limit: 2.0,
            ratio: 1.01,
            exploded: 1e6,
            searches,
        };
        report.write(&mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn bars_grow_with_the_logarithm_of_the_step() {
        let axis = Axis { low: -2.0, high: 1.0 };
        assert_eq!((axis.place(0.01), axis.place(10.0)), (0.0, WIDTH));
        assert!((axis.place(1.0) - 2.0 * axis.place(0.1)).abs() < 1e-12);
        let labels: Vec<String> = axis.ticks().into_iter().map(|(_, label)| label).collect();
        assert_eq!(labels, ["0.01 s", "0.1 s", "1 s", "10 s"]);
        let labels: Vec<String> = Axis { low: -2.0, high: 0.0 }.ticks().into_iter().map(|(_, label)| label).collect();
        assert_eq!(labels, ["0.01 s", "0.02 s", "0.05 s", "0.1 s", "0.2 s", "0.5 s", "1 s"]);
    }

    #[test]
    fn short_steps_are_written_shortly() {
        assert_eq!([digits(0.0078906), digits(0.005), digits(0.596875)], ["0.00789", "0.005", "0.597"]);
        assert_eq!([tick_label(1e-3), tick_label(1e-5)], ["0.001 s", "10<sup>\u{2212}5</sup> s"]);
        assert_eq!(Axis { low: -5.0, high: -2.0 }.ticks().len(), 4);
    }

    #[test]
    fn every_outcome_of_a_search_is_told() {
        let page = page(&[
            Search { method: "<all>", completes: 2.0, fails: None, runs: 8 },
            Search { method: "some", completes: 0.3, fails: Some(0.303), runs: 12 },
            Search { method: "none", completes: 0.0, fails: Some(1.22e-5), runs: 11 },
        ]);
        for told in
            ["A &amp; B", "&lt;all&gt;", "≥ 2 s", ">0.3 s<", ">0.303<", "no step completes, down to 1.22", "3 methods", "within 1\u{202f}%"]
        {
            assert!(page.contains(told), "{told}");
        }
        assert!(!page.contains("<script") && page.matches("class=\"bar").count() - page.matches("class=\"bars").count() == 2);
    }

    #[test]
    fn the_axis_holds_every_bar() {
        let searches = [3e-7, 0.01, 2.0].map(|completes| Search { method: "m", completes, fails: None, runs: 1 });
        let report = StabilityReport {
            title: "",
            model_text: "",
            provenance: &serde_json::Value::Null,
            end: 20.0,
            first: 0.025,
            limit: 2.0,
            ratio: 1.01,
            exploded: 1e6,
            searches: &searches,
        };
        let axis = Axis::of(&report);
        assert!(searches.iter().all(|search| (1.0..WIDTH + 1e-9).contains(&axis.place(search.completes))));
    }

    #[test]
    fn no_method_is_no_fault() {
        assert!(page(&[]).contains("0 methods"));
    }
}
