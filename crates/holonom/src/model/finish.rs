//! From what has been read to a model: its picture, what is recorded of it, and the system.

use std::sync::Arc;

use super::assembly::{self, Assembly};
use super::bodies::frame::Frame;
use super::unseen::OverTime;
use super::{BarInfo, BodyInfo, Model, Output, PointInfo, Settings, joints};
use crate::record::{
    Acts, Channels, PointKind, RecordedEffort, RecordedHold, RecordedJoint, RecordedPoint, RecordedTransmission, Scene, SceneBody,
    ScenePoint,
};
use crate::system::Place;

/// Puts together what has been read without a fault.
pub(super) fn finish(
    mut assembly: Assembly<'_>,
    title: String,
    settings: Settings,
    output: Output,
    bars: Vec<BarInfo>,
    over_time: Vec<OverTime>,
) -> Model {
    let notes = assembly.sink.notes();
    assembly.doubt_forces();
    let channels = channels(&assembly);
    let Assembly {
        builder,
        axes,
        gravity,
        points,
        lines,
        bodies,
        frames,
        body_places,
        joints,
        scene_joints,
        loads,
        bushings,
        wheels,
        efforts,
        couplings,
        rods,
        holds,
        forces,
        signals,
        ..
    } = assembly;
    let first_custom = builder.rows();
    let place = |point: &assembly::PlacedPoint| point.end.place().expect("a point is a node");
    let kind = |point: &assembly::PlacedPoint| match (place(point), point.end.free) {
        (Place::Fixed(_), _) => PointKind::Fixed,
        (_, true) => PointKind::Free,
        (_, false) => PointKind::Driven,
    };
    let scene_bodies = bodies.iter().zip(body_places).map(|(body, places)| SceneBody {
        name: body.name.clone(),
        mass: body.mass,
        shape: body.shape.clone(),
        places: places.into_iter().chain(body.points.iter().map(|&(_, at)| body.local(at))).map(|at| axes.in_world(at)).collect(),
    });
    let scene = Scene {
        axes: axes.name.to_string(),
        gravity: axes.in_world(gravity),
        points: points.iter().map(|point| ScenePoint { name: point.name.clone(), kind: kind(point), mass: point.mass }).collect(),
        lines,
        bodies: scene_bodies.collect(),
        joints: scene_joints,
        loads,
        bushings,
        wheels,
    };
    let bodies: Vec<BodyInfo> = bodies.iter().zip(&frames).map(|(body, frame)| BodyInfo::new(body, frame, axes)).collect();
    let points = points
        .into_iter()
        .map(|point| PointInfo { kind: kind(&point), place: place(&point), name: point.name, mass: point.mass, velocity: point.velocity })
        .collect();
    Model {
        title,
        dimension: axes.dimension(),
        axes: axes.name,
        gravity: scene.gravity,
        system: builder.build().into(),
        settings,
        output,
        scene,
        points,
        bars,
        channels: Arc::new(Channels {
            bodies: bodies.iter().map(|body| Arc::clone(&body.recorded)).collect(),
            forces,
            efforts: recorded_efforts(efforts),
            couplings,
            rods,
            holds: recorded_holds(holds, first_custom),
            inputs: signals.inputs,
            ..channels
        }),
        bodies,
        joints,
        notes,
        at_equilibrium: false,
        over_time,
        frames,
    }
}

fn recorded_efforts(efforts: Vec<assembly::Effort>) -> Vec<RecordedEffort> {
    efforts.into_iter().map(|assembly::Effort { name, row, length, is_moment }| RecordedEffort { name, row, length, is_moment }).collect()
}

/// Rows of formulas come behind all others.
fn recorded_holds(mut holds: Vec<RecordedHold>, first_custom: usize) -> Vec<RecordedHold> {
    for hold in holds.iter_mut().filter(|hold| matches!(hold.acts, Acts::Formula(_))) {
        hold.rows = hold.rows.start + first_custom..hold.rows.end + first_custom;
    }
    holds
}

/// Points, named points of bodies, and the forces of joints and what they bear of couplers.
fn channels(assembly: &Assembly<'_>) -> Channels {
    let Assembly { axes, points, bodies, frames, joints, .. } = assembly;
    let own = points.iter().map(|point| RecordedPoint { name: point.name.clone(), terms: point.end.terms.clone() });
    let named = bodies.iter().zip(frames).flat_map(|(body, frame)| {
        body.points.iter().map(move |(name, at)| RecordedPoint { name: format!("{}.{name}", body.name), terms: frame.point(*at) })
    });
    let of_joints: Vec<Option<RecordedJoint>> = joints.iter().map(|joint| recorded_joint(assembly, joint)).collect();
    // Numbers among the joints that are recorded.
    let number = |count: &mut usize, joint: &Option<RecordedJoint>| {
        let own = *count;
        *count += usize::from(joint.is_some());
        Some(own)
    };
    let numbers: Vec<usize> = of_joints.iter().scan(0, number).collect();
    let transmissions = assembly
        .transmissions
        .iter()
        .map(|transmission| RecordedTransmission { joints: transmission.joints.map(|joint| numbers[joint]), ..transmission.clone() });
    let of_joint = |joint: &joints::JointInfo| {
        let angles = joint.coordinates.iter().filter(|coordinate| coordinate.is_angle);
        angles.map(|coordinate| format!("{}.{}", joint.name, coordinate.name)).collect::<Vec<_>>()
    };
    let of_bodies = bodies.iter().filter(|_| axes.dimension() == 2).map(|body| format!("{}.angle", body.name));
    Channels {
        axes: axes.name.to_string(),
        points: own.chain(named).collect(),
        transmissions: transmissions.collect(),
        joints: of_joints.into_iter().flatten().collect(),
        angles: joints.iter().flat_map(of_joint).chain(of_bodies).collect(),
        ..Channels::default()
    }
}

/// A joint with its force; none of a bar's pin where nodes that it shares with others stand for rows.
fn recorded_joint(assembly: &Assembly<'_>, joint: &joints::JointInfo) -> Option<RecordedJoint> {
    let [first, second] = joint.geometry.members.map(|member| assembly.frame(member));
    // The force on the ground is that on the other side, the other way; and so is that on a bar, whose ends are nodes of others, too.
    let is_apart = |frame: &Frame| !matches!(frame, Frame::Ground | Frame::Bar(_));
    let is_second = is_apart(&second) || !(is_apart(&first) || matches!(second, Frame::Ground));
    let [nodes, others] = if is_second { [&second, &first] } else { [&first, &second] }.map(|frame| {
        let nodes = frame.nodes().into_iter().map(|(node, _)| (node, !assembly.builder.is_direction(node)));
        nodes.collect::<Vec<_>>()
    });
    let is_mixed = joint.geometry.is_of_bar() && (joint.is_shared || nodes.iter().any(|node| others.contains(node)));
    (!is_mixed).then(|| RecordedJoint {
        name: joint.name.clone(),
        rows: joint.rows.clone(),
        is_known: !joint.is_shared,
        nodes,
        sign: if is_second { 1.0 } else { -1.0 },
        at: second.point(joint.geometry.at[1]),
    })
}
