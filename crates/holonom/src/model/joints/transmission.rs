//! Where the wheels of a coupler sit, so that the forces of teeth and belts count in their bearings (methods §17).

use super::pair::{Coordinate, JointInfo};
use crate::model::assembly::Assembly;
use crate::model::bodies::nodes::Member;
use crate::model::entry::Entry;
use crate::model::fault::Read;
use crate::model::geometry::{Vec3, cross, dot, norm, scale, subtract};
use crate::record::Transmission;

/// A coupler whose forces are recorded, in reference coordinates.
pub struct TransmissionInfo {
    pub name: String,
    pub row: usize,
    pub factor: f64,
    /// Its joints among those of the model.
    pub joints: [usize; 2],
    /// Which side of each joint the wheel is on.
    pub wheels: [usize; 2],
    pub carrier: Member,
    pub axis: Vec3,
    /// The way of a rack.
    pub way: Vec3,
    pub kind: Transmission,
}

/// How the two joints of a coupler sit on the part that carries both.
pub(super) struct Seats {
    joints: [usize; 2],
    wheels: [usize; 2],
    carrier: Member,
    /// The axis of the first joint, and that of the second or its way.
    axes: [Vec3; 2],
    /// From the first joint to the second, across the axis of the first, m.
    pub across: Vec3,
    /// 1 where the coordinate of a joint counts the way its wheel turns about the axis of the first (the way a rack goes), else −1.
    pub senses: [f64; 2],
}

/// Two directions whose sine or cosine is this small are at right angles or parallel.
const SKEW: f64 = 1e-6;

impl Seats {
    /// Of joints that turn about parallel axes, or of one that turns and one that slides at right angles to that axis; `key` asks for them.
    pub fn of(assembly: &Assembly<'_>, entry: &Entry<'_>, key: &'static str, coordinates: [&Coordinate; 2]) -> Read<Self> {
        let infos: [&JointInfo; 2] = {
            let spot = |k: usize| crate::model::entry::Spot { key: "joints", item: Some(k) };
            [assembly.joint(entry, spot(0), &coordinates[0].joint)?, assembly.joint(entry, spot(1), &coordinates[1].joint)?]
        };
        let slides = !coordinates[1].is_angle;
        let is_known = |coordinate: &Coordinate| ["angle", "displacement"].contains(&coordinate.name);
        let [first, second] = infos.map(|info| info.geometry.members);
        let common: Vec<Member> = first.into_iter().filter(|member| second.contains(member)).collect();
        let ([carrier], true) = (&common[..], coordinates.iter().all(|coordinate| is_known(coordinate))) else {
            let message =
                format!("`{}` and `{}` are not two joints with one axis each on one part that carries both", infos[0].name, infos[1].name);
            return Err(entry.refuse_key(key, message, format!("leave `{key}` out: then bearings do not feel the coupler")));
        };
        let wheels = infos.map(|info| usize::from(info.geometry.members[0] == *carrier));
        let is_planar = assembly.dimension() == 2;
        let axes = infos.map(|info| info.geometry.triad[0][0]);
        let [axis, other] = match (is_planar, slides) {
            (true, false) => [[0.0, 0.0, 1.0]; 2],
            (true, true) => [[0.0, 0.0, 1.0], axes[1]],
            (false, _) => axes,
        };
        let (sine, cosine) = (norm(cross(axis, other)), dot(axis, other));
        if (if slides { cosine.abs() } else { sine }) > SKEW {
            let what = if slides { "the rack goes along the axis of the wheel" } else { "the axes are not parallel" };
            return Err(entry.refuse_key(key, format!("{what}, and where teeth touch is not known"), format!("leave `{key}` out")));
        }
        let apart = subtract(infos[1].geometry.at[0], infos[0].geometry.at[0]);
        let side = |k: usize| if wheels[k] == 1 { 1.0 } else { -1.0 };
        let places = infos.map(|info| assembly.joint_names[&info.name]);
        Ok(Self {
            joints: places,
            wheels,
            carrier: *carrier,
            axes: [axis, other],
            across: subtract(apart, scale(axis, dot(axis, apart))),
            senses: [side(0), side(1) * if slides { 1.0 } else { cosine.signum() }],
        })
    }

    /// Has the forces recorded of a coupler whose row comes next and has this factor of the first coordinate.
    pub fn record(self, assembly: &mut Assembly<'_>, entry: &Entry<'_>, factor: f64, kind: Transmission) {
        let Self { joints, wheels, carrier, axes: [axis, way], .. } = self;
        let (name, row) = (entry.name.to_string(), assembly.builder.rows());
        assembly.transmissions.push(TransmissionInfo { name, row, factor, joints, wheels, carrier, axis, way, kind });
    }
}

/// Tangent of a pressure angle.
pub(super) fn slope(entry: &Entry<'_>, angle: f64) -> Read<f64> {
    if (0.0..std::f64::consts::FRAC_PI_2).contains(&angle) {
        return Ok(angle.tan());
    }
    Err(entry.refuse("pressure_angle", format!("a pressure angle of {angle} rad is none"), "it is at least 0 and below 90*deg"))
}
