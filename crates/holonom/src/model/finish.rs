//! From what has been read to a model: its picture, what is recorded of it, and the system.

use super::assembly::{self, Assembly, Axes};
use super::bodies::frame::Frame;
use super::bodies::nodes::Member;
use super::unseen::OverTime;
use super::{BarInfo, BodyInfo, Model, Output, PointInfo, RigidBody, Settings, joints};
use crate::record::{Channels, PointKind, RecordedEffort, RecordedJoint, RecordedPoint, Scene, SceneBody, ScenePoint};
use crate::system::Place;

/// Puts together what has been read without a fault.
pub(super) fn finish(
    assembly: Assembly<'_>,
    title: String,
    settings: Settings,
    output: Output,
    bars: Vec<BarInfo>,
    over_time: Vec<OverTime>,
) -> Model {
    let notes = assembly.sink.notes();
    let Assembly {
        mut builder,
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
        transmissions,
        forces,
        signals,
        ..
    } = assembly;
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
    let channels = channels(axes, &points, &bodies, &frames, &joints);
    let bodies: Vec<BodyInfo> = bodies.iter().zip(&frames).map(|(body, frame)| BodyInfo::new(body, frame, axes, &mut builder)).collect();
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
        channels: Channels {
            bodies: bodies.iter().map(|body| body.recorded.clone()).collect(),
            forces,
            efforts: recorded_efforts(efforts),
            couplings,
            rods,
            transmissions,
            inputs: signals.inputs,
            ..channels
        },
        bodies,
        joints,
        notes,
        over_time,
        frames,
    }
}

fn recorded_efforts(efforts: Vec<assembly::Effort>) -> Vec<RecordedEffort> {
    efforts.into_iter().map(|assembly::Effort { name, row, length, is_moment }| RecordedEffort { name, row, length, is_moment }).collect()
}

/// Points, named points of bodies, and the forces of joints.
fn channels(
    axes: Axes,
    points: &[assembly::PlacedPoint],
    bodies: &[RigidBody],
    frames: &[Frame],
    joints: &[joints::JointInfo],
) -> Channels {
    let own = points.iter().map(|point| RecordedPoint { name: point.name.clone(), terms: point.end.terms.clone() });
    let named = bodies.iter().zip(frames).flat_map(|(body, frame)| {
        body.points.iter().map(move |(name, at)| RecordedPoint { name: format!("{}.{name}", body.name), terms: frame.point(*at) })
    });
    let joint = |joint: &joints::JointInfo| {
        let [first, second] = joint.geometry.members.map(|member| match member {
            Member::Ground => Frame::Ground,
            Member::Point(k) => Frame::Particle(points[k].end.place().expect("a point is a node")),
            Member::Body(k) => frames[k].clone(),
        });
        // The force on the ground is that on the other side, the other way.
        let is_second = !matches!(second, Frame::Ground);
        RecordedJoint {
            name: joint.name.clone(),
            rows: joint.rows.clone(),
            is_known: !joint.is_shared,
            nodes: if is_second { second.nodes() } else { first.nodes() },
            sign: if is_second { 1.0 } else { -1.0 },
            at: second.point(joint.geometry.at[1]),
        }
    };
    let of_joint = |joint: &joints::JointInfo| {
        let angles = joint.coordinates.iter().filter(|coordinate| coordinate.is_angle);
        angles.map(|coordinate| format!("{}.{}", joint.name, coordinate.name)).collect::<Vec<_>>()
    };
    let of_bodies = bodies.iter().filter(|_| axes.dimension() == 2).map(|body| format!("{}.angle", body.name));
    Channels {
        axes: axes.name.to_string(),
        points: own.chain(named).collect(),
        joints: joints.iter().map(joint).collect(),
        angles: joints.iter().flat_map(of_joint).chain(of_bodies).collect(),
        ..Channels::default()
    }
}
