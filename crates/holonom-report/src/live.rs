//! What a widget of a notebook shows while a simulation goes on; the other side is `viewer/src/live.ts`.

use crate::data::coordinates;
use holonom::record::Scene;
use serde::Serialize;

/// Script, a module, and style sheet of the widget, if the viewer is part of this build.
#[cfg(feature = "viewer")]
pub const LIVE: Option<(&str, &str)> = Some((include_str!(concat!(env!("OUT_DIR"), "/bundle/live.js")), crate::page::STYLE));
/// Script, a module, and style sheet of the widget, if the viewer is part of this build.
#[cfg(not(feature = "viewer"))]
pub const LIVE: Option<(&str, &str)> = None;

/// What the frames of a simulation are made of: 64-bit floats, the time, then the coordinates of points, then the poses of bodies.
#[derive(Serialize)]
pub struct Frames<'a> {
    scene: &'a Scene,
    points: Vec<&'a str>,
    bodies: Vec<&'a str>,
}

impl<'a> Frames<'a> {
    /// Frames of what is recorded of a scene: of the rest nothing is drawn.
    pub fn new(scene: &'a Scene, is_recorded: impl Fn(&str) -> bool) -> Self {
        let [place, pose] = coordinates(scene);
        let is_whole = |name: &str, endings: &[&str]| endings.iter().all(|ending| is_recorded(&format!("{name}.{ending}")));
        let points = scene.points.iter().map(|point| point.name.as_str()).filter(|name| is_whole(name, &place));
        let bodies = scene.bodies.iter().map(|body| body.name.as_str()).filter(|name| is_whole(name, &pose));
        Self { scene, points: points.collect(), bodies: bodies.collect() }
    }

    /// The columns of a frame, in its order.
    pub fn columns(&self) -> Vec<String> {
        let [place, pose] = coordinates(self.scene);
        let of = |name: &&str, endings: &[&str]| endings.iter().map(|ending| format!("{name}.{ending}")).collect::<Vec<_>>();
        let points = self.points.iter().flat_map(|name| of(name, &place));
        let bodies = self.bodies.iter().flat_map(|name| of(name, &pose));
        ["t".into()].into_iter().chain(points).chain(bodies).collect()
    }
}
