// The two sides of a joint: where its place and axis are in the axes of each body, or in the world.

import { Quaternion, Vector3 } from "three";
import { carried, seenFrom, type Motion, type Pose } from "../motion";
import type { Joint } from "../payload";

export interface Side {
  /** A body, or a point of the model; null: the world. */
  body: string | null;
  at: Vector3;
  /** Unit length; across the plane, or up, where the joint has none. */
  axis: Vector3;
}

const WORLD: Pose = { place: new Vector3(), turn: new Quaternion() };

/** Where a body, a point or the world is in a row. */
export function poseOf(motion: Motion, body: string | null, row: number): Pose | undefined {
  if (body === null) return WORLD;
  const point = motion.inRow(body, row);
  return point ? { place: new Vector3(...point), turn: new Quaternion() } : motion.poseInRow(body, row);
}

/** The side that carries the joint, and the other one as it lies at the start; nothing where a body has no motion. */
export function sidesOf(motion: Motion, joint: Joint): [Side, Side] | undefined {
  const [pose, other] = [poseOf(motion, joint.body, 0), poseOf(motion, joint.other, 0)];
  if (!pose || !other) return undefined;
  const axis = joint.axis ? new Vector3(...joint.axis) : motion.across.clone();
  if (axis.length() === 0) axis.copy(motion.across);
  const here: Side = { body: joint.body, at: new Vector3(...joint.at), axis: axis.normalize() };
  const worldAxis = here.axis.clone().applyQuaternion(pose.turn);
  return [here, { body: joint.other, at: seenFrom(other, carried(pose, joint.at)), axis: worldAxis.applyQuaternion(other.turn.clone().invert()) }];
}

/** The axis of a joint in the axes of each of its bodies. */
export function jointAxes(motion: Motion, joint: Joint): { body: string; axis: Vector3 }[] {
  return (sidesOf(motion, joint) ?? []).flatMap(({ body, axis }) => (body === null ? [] : [{ body, axis }]));
}

/** How far the other side goes along the axis, seen from the side that carries the joint, m: least and most. */
export function travel(motion: Motion, [here, other]: [Side, Side]): [number, number] {
  const rows = motion.run.times.length;
  const step = Math.max(1, Math.floor(rows / 200));
  let [least, most] = [0, 0];
  for (let row = 0; row < rows; row += step) {
    const [from, to] = [poseOf(motion, here.body, row), poseOf(motion, other.body, row)];
    if (!from || !to) continue;
    const along = seenFrom(from, carried(to, other.at.toArray())).sub(here.at).dot(here.axis);
    [least, most] = [Math.min(least, along), Math.max(most, along)];
  }
  return [least, most];
}
