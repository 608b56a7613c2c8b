//! The page of a mechanism's modes: their frequencies, and the mechanism that swings in the one that is chosen.

use std::collections::BTreeMap;
use std::io;

use crate::data::middle;
use crate::escape::{html, json_in_script};
use crate::{base64, page, provenance};
use holonom::model::Sway;
use holonom::record::Scene;
use serde::Serialize;

/// One mode.
pub struct ModeShape {
    /// Its number, frequency in Hz, damping, the time in which it falls off, s, and what moves, in words.
    pub row: [String; 5],
    /// Points and bodies at rest, with the real parts of the velocities of the mode.
    pub real: [Vec<Sway>; 2],
    /// The same with the imaginary parts.
    pub imaginary: [Vec<Sway>; 2],
}

/// A page about the small vibrations of a mechanism.
pub struct ModesReport<'a> {
    /// Heading of the page, as plain text.
    pub title: &'a str,
    /// The model file, shown at the bottom.
    pub model_text: &'a str,
    /// What was run, as in `summary.json`.
    pub provenance: &'a serde_json::Value,
    /// How the viewer draws the mechanism.
    pub scene: &'a Scene,
    /// In the order of the table.
    pub modes: &'a [ModeShape],
    /// What else is said of them.
    pub notes: &'a [String],
}

/// What the viewer reads; the other side is `viewer/src/modes.ts`.
#[derive(Serialize)]
struct Data<'a> {
    /// What the places of the picture are counted from, in world axes, m.
    origin: [f64; 3],
    scene: &'a Scene,
    /// Name of a point or of a body → its pose at rest, along `scene.axes` from the origin of the page.
    points: BTreeMap<&'a str, Vec<f64>>,
    bodies: BTreeMap<&'a str, Vec<f64>>,
    modes: Vec<Shape>,
}

/// How a mode moves everything; velocities that are as large as one likes together.
#[derive(Serialize)]
struct Shape {
    /// What the reader calls it.
    label: String,
    /// Name → real parts along the coordinates, then imaginary parts, base64 of 32-bit floats.
    points: BTreeMap<String, String>,
    bodies: BTreeMap<String, String>,
}

/// Numbers that a page holds; of more the fastest modes are left out of the picture.
const MAX_NUMBERS: usize = 2_000_000;

impl ModesReport<'_> {
    /// Writes the page.
    pub fn write(&self, out: &mut dyn io::Write) -> io::Result<()> {
        page::head(self.title, page::VIEWER.map_or("", |(style, _)| style), out)?;
        writeln!(
            out,
            "<header>\n<h1>{}</h1>\n<p class=\"method\">Small vibrations about the start</p>\n</header>\n<main>",
            html(self.title)
        )?;
        let is_drawn = !self.modes.is_empty();
        match page::VIEWER {
            _ if !is_drawn => (),
            Some(_) => writeln!(
                out,
                "<noscript><p class=\"note\">The moving picture needs JavaScript.</p></noscript>\n<section id=\"motion\" aria-label=\"Motion\"></section>"
            )?,
            None => writeln!(out, "{}", page::WITHOUT_VIEWER)?,
        }
        if is_drawn {
            self.table(out)?;
        }
        page::notes(self.notes.iter().cloned(), out)?;
        provenance::write(&[(self.title, self.provenance)], out)?;
        page::model(self.model_text, out)?;
        writeln!(out, "</main>")?;
        if let Some((_, script)) = page::VIEWER.filter(|_| is_drawn) {
            let json = serde_json::to_string(&self.data()).map_err(io::Error::other)?;
            writeln!(out, "<script type=\"application/json\" id=\"holonom-modes\">{}</script>", json_in_script(&json))?;
            writeln!(out, "<script>\n{script}</script>")?;
        }
        page::end(out)
    }

    fn table(&self, out: &mut dyn io::Write) -> io::Result<()> {
        writeln!(
            out,
            "<section>\n<div class=\"modes\"><table class=\"figures\"><thead><tr><th scope=\"col\">mode</th>\
             <th scope=\"col\" class=\"number\">frequency<small>Hz</small></th><th scope=\"col\" class=\"number\">damping<small>of the critical</small></th>\
             <th scope=\"col\" class=\"number\">falls to 1/e in<small>s</small></th><th scope=\"col\">what moves, over what moves most</th></tr></thead><tbody>"
        )?;
        for ModeShape { row: [number, hertz, damping, time, moves], .. } in self.modes {
            let cells: String = [hertz, damping, time].iter().map(|cell| format!("<td class=\"number\">{}</td>", html(cell))).collect();
            writeln!(out, "<tr><th scope=\"row\">{}</th>{cells}<td>{}</td></tr>", html(number), html(moves))?;
        }
        writeln!(out, "</tbody></table></div>\n</section>")
    }

    fn data(&self) -> Data<'_> {
        let rest = self.modes.first().map_or([&[][..], &[][..]], |mode| [&mode.real[0][..], &mode.real[1][..]]);
        let axes: Vec<usize> = self.scene.axes.chars().filter_map(|axis| "xyz".find(axis)).collect();
        let mut origin = [0.0; 3];
        for (k, &axis) in axes.iter().enumerate() {
            origin[axis] = middle(rest.into_iter().flatten().map(|sway| sway.pose[k])).unwrap_or_default();
        }
        let from = |k: usize| axes.get(k).map_or(0.0, |&axis| origin[axis]);
        let pose = |sway: &Sway| sway.pose.iter().enumerate().map(|(k, x)| x - from(k)).collect();
        let [points, bodies] = rest.map(|of| of.iter().map(|sway| (sway.name.as_str(), pose(sway))).collect());
        let numbers: usize = rest.into_iter().flatten().map(|sway| 2 * sway.rate.len()).sum();
        let modes = self.modes.iter().take(MAX_NUMBERS / numbers.max(1)).map(shape).collect();
        Data { origin, scene: self.scene, points, bodies, modes }
    }
}

/// A shape as the viewer reads it.
fn shape(mode: &ModeShape) -> Shape {
    let [points, bodies] = [0, 1].map(|kind| {
        let parts = mode.real[kind].iter().zip(&mode.imaginary[kind]);
        parts.map(|(real, imaginary)| (real.name.as_str(), [&real.rate[..], &imaginary.rate].concat())).collect::<Vec<_>>()
    });
    // Velocities of a mode may have any size, and single precision has not all of them.
    let most = points.iter().chain(&bodies).flat_map(|(_, rates)| rates).fold(0.0, |most: f64, rate| most.max(rate.abs()));
    let scale = if most > 0.0 { most } else { 1.0 };
    let coded = |of: Vec<(&'_ str, Vec<f64>)>| {
        of.into_iter()
            .map(|(name, rates)| (name.to_owned(), base64::singles(&rates.iter().map(|rate| (rate / scale) as f32).collect::<Vec<_>>())))
            .collect()
    };
    let [number, hertz, _, time, _] = &mode.row;
    let label = match (hertz.as_str(), time.as_str()) {
        ("-", grows) if grows.starts_with("grows") => format!("mode {number}: {grows} s"),
        ("-", falls) => format!("mode {number}: falls to 1/e in {falls} s"),
        _ => format!("mode {number}: {hertz} Hz"),
    };
    Shape { label, points: coded(points), bodies: coded(bodies) }
}
