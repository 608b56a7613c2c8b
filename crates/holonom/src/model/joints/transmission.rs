//! Where the wheels of a coupler sit, so that the forces of teeth and belts count in their bearings (methods §17).

use super::pair::{Coordinate, JointInfo};
use crate::model::assembly::{Assembly, CONTRADICTION};
use crate::model::bodies::nodes::Member;
use crate::model::entry::{Entry, Spot};
use crate::model::fault::Read;
use crate::model::geometry::{Vec3, cross, dot, norm, scale, subtract};
use crate::record::{RecordedTransmission, SceneWheels, Transmission, WheelsKind};
use crate::system::Term;

/// How the two joints of a coupler sit on the part that carries both.
pub(super) struct Seats {
    joints: [usize; 2],
    /// 1 where the wheel (or the rack) is the second body of its joint, −1 where it is the first.
    sides: [f64; 2],
    carrier: Member,
    /// The axis of the first joint, and that of the second or its way.
    axes: [Vec3; 2],
    /// From the first joint to the second, across the axis of the first, m; nothing where both have one axis.
    pub distance: f64,
    /// 1 where the coordinate of a joint counts the way its wheel turns about the axis of the first (the way a rack goes), else −1.
    pub senses: [f64; 2],
}

/// Two directions whose sine or cosine is this small are at right angles or parallel.
const SKEW: f64 = 1e-6;

impl Seats {
    /// Those that were found, which `key` asks for.
    pub fn wanted(found: Result<Self, String>, entry: &Entry<'_>, key: &'static str) -> Read<Self> {
        found.map_err(|message| entry.refuse_key(key, message, format!("leave `{key}` out: then bearings do not feel the coupler")))
    }

    /// Of joints that turn about parallel axes, or of one that turns and one that slides at right angles to that axis, or why there are none.
    pub fn find(assembly: &mut Assembly<'_>, entry: &Entry<'_>, coordinates: [&Coordinate; 2]) -> Read<Result<Self, String>> {
        let infos: [&JointInfo; 2] = {
            let spot = |k| Spot { key: "joints", item: Some(k) };
            [assembly.joint(entry, spot(0), &coordinates[0].joint)?, assembly.joint(entry, spot(1), &coordinates[1].joint)?]
        };
        if let Some(info) = infos.iter().find(|info| info.geometry.is_of_bar()) {
            return Ok(Err(format!("`{}` is at a bar, and not between bodies", info.name)));
        }
        let slides = !coordinates[1].is_angle;
        let [first, second] = infos.map(|info| info.geometry.members);
        let common: Vec<Member> = first.into_iter().filter(|member| second.contains(member)).collect();
        let ([carrier], [Some(about), Some(other)], true) = (&common[..], coordinates.map(|known| known.about), coordinates[0].is_angle)
        else {
            let message = format!(
                "`{}` and `{}` are not two axles, or an axle and a rail, on one part that carries both",
                infos[0].name, infos[1].name
            );
            if common.is_empty() {
                assembly.wheels_apart.push((entry.name.to_string(), [first, second]));
            }
            return Ok(Err(message));
        };
        let sides = infos.map(|info| if info.geometry.members[0] == *carrier { 1.0 } else { -1.0 });
        let is_planar = assembly.dimension() == 2;
        let axes = [(infos[0], about), (infos[1], other)].map(|(info, about)| info.geometry.triad[0][about]);
        let [axis, other] = match (is_planar, slides) {
            (true, false) => [[0.0, 0.0, 1.0]; 2],
            (true, true) => [[0.0, 0.0, 1.0], axes[1]],
            (false, _) => axes,
        };
        let (sine, cosine) = (norm(cross(axis, other)), dot(axis, other));
        if (if slides { cosine.abs() } else { sine }) > SKEW {
            let what = if slides { "the rack goes along the axis of the wheel" } else { "the axes are not parallel" };
            return Ok(Err(format!("{what}, and where teeth touch is not known")));
        }
        let apart = subtract(infos[1].geometry.at[0], infos[0].geometry.at[0]);
        let across = norm(subtract(apart, scale(axis, dot(axis, apart))));
        Ok(Ok(Self {
            joints: infos.map(|info| assembly.joint_names[&info.name]),
            sides,
            carrier: *carrier,
            axes: [axis, other],
            distance: if across > CONTRADICTION * assembly.builder.size() { across } else { 0.0 },
            senses: [sides[0], sides[1] * if slides { 1.0 } else { cosine.signum() }],
        }))
    }

    /// Draws wheels of these radii, m; none of a rack.
    pub fn draw(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>, kind: WheelsKind, radii: [Option<f64>; 2]) {
        let infos = self.joints.map(|k| &assembly.joints[k]);
        let wheel = |k: usize| match infos[k].geometry.members[usize::from(self.sides[k] > 0.0)] {
            Member::Body(body) => Some(assembly.bodies[body].name.clone()),
            _ => None,
        };
        let (joints, bodies) = (infos.map(|info| info.name.clone()), [0, 1].map(wheel));
        assembly.wheels.push(SceneWheels { name: entry.name.to_string(), kind, joints, bodies, radii });
    }

    /// The way of a rack, as a direction of the carrier.
    pub fn way(&self, assembly: &Assembly<'_>) -> Vec<Term> {
        assembly.frame(self.carrier).vector(self.axes[1])
    }

    /// Has the forces recorded of a coupler whose row comes next and has this factor of the first coordinate.
    pub fn record(self, assembly: &mut Assembly<'_>, entry: &Entry<'_>, factor: f64, kind: Transmission) {
        let axis = if assembly.dimension() == 2 { Vec::new() } else { assembly.frame(self.carrier).vector(self.axes[0]) };
        let (name, row) = (entry.name.to_string(), assembly.builder.rows());
        assembly.transmissions.push(RecordedTransmission { name, row, factor, joints: self.joints, sides: self.sides, axis, kind });
    }
}

/// Tangent of a pressure angle.
pub(super) fn slope(entry: &Entry<'_>, angle: f64) -> Read<f64> {
    if (0.0..std::f64::consts::FRAC_PI_2).contains(&angle) {
        return Ok(angle.tan());
    }
    Err(entry.refuse("pressure_angle", format!("a pressure angle of {angle} rad is none"), "it is at least 0 and below 90*deg"))
}
