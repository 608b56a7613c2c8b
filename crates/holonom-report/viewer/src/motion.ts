// Where the points and bodies of a run are at any time, interpolated between rows. Places in the world are counted from `Run.origin`.

import { Matrix4, Quaternion, Vector3 } from "three";
import type { Anchor, Run, Vec3 } from "./payload";

/** The largest row whose time is not after t; 0 before the start. Times ascend. */
export function rowAt(times: Float64Array, t: number): number {
  let low = 0;
  let high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** Of a body: its centre of mass in the world, and the rotation from its axes to those of the world. */
export interface Pose {
  place: Vector3;
  turn: Quaternion;
}

/** World place of a place in the axes of a body. */
export function carried(pose: Pose, at: Vec3): Vector3 {
  return new Vector3(...at).applyQuaternion(pose.turn).add(pose.place);
}

/** Place in the axes of a body of a place in the world. */
export function seenFrom(pose: Pose, place: Vector3): Vector3 {
  return place.clone().sub(pose.place).applyQuaternion(pose.turn.clone().invert());
}

export class Motion {
  /** From first axis, second axis and normal of a planar model to those of the world; in space the identity. */
  readonly plane = new Quaternion();
  /** Across the plane of a planar model, towards the camera; z in space. */
  readonly across = new Vector3(0, 0, 1);
  /** Which world axis (0–2) each recorded coordinate belongs to. */
  private readonly axes: number[];

  /** How far back the trails of this run go, s. */
  readonly trail: number;

  /** `room`: how far it may go beyond the places of its rows, over its size. */
  constructor(readonly run: Run, trail?: number, readonly room = 0) {
    this.trail = trail ?? (this.end - (run.times[0] ?? 0)) / 8;
    this.axes = [...run.scene.axes].map((axis) => "xyz".indexOf(axis));
    if (!this.planar) return;
    const [first, second] = this.axes.map((axis) => new Vector3().setComponent(axis, 1));
    this.across.crossVectors(first, second);
    this.plane.setFromRotationMatrix(new Matrix4().makeBasis(first, second, this.across));
  }

  get planar(): boolean {
    return this.axes.length === 2;
  }

  get end(): number {
    return this.run.times.at(-1) ?? 0;
  }

  /** World place of a point in a row; a planar model has 0 in the missing coordinate. */
  inRow(name: string, row: number): Vec3 | undefined {
    const path = this.run.points.get(name);
    if (!path || path.length === 0) return undefined;
    const place: Vec3 = [0, 0, 0];
    this.axes.forEach((axis, i) => (place[axis] = path[row * this.axes.length + i]));
    return place;
  }

  /** World place of a point at time t; undefined where the run has no finite number. */
  at(name: string, t: number): Vec3 | undefined {
    const { times } = this.run;
    const row = rowAt(times, t);
    const from = this.inRow(name, row);
    if (!from || !from.every(Number.isFinite)) return undefined;
    const to = row + 1 < times.length ? this.inRow(name, row + 1) : undefined;
    if (!to || !to.every(Number.isFinite)) return from;
    const share = Math.min(Math.max((t - times[row]) / (times[row + 1] - times[row]), 0), 1);
    return [0, 1, 2].map((i) => from[i] + share * (to[i] - from[i])) as Vec3;
  }

  /** Where a body is in a row; undefined where the run has no finite number. */
  poseInRow(name: string, row: number): Pose | undefined {
    const path = this.run.bodies.get(name);
    const width = this.planar ? 3 : 7;
    const first = row * width;
    if (!path || path.length < first + width) return undefined;
    for (let i = 0; i < width; i++) if (!Number.isFinite(path[first + i])) return undefined;
    const place = new Vector3();
    this.axes.forEach((axis, i) => place.setComponent(axis, path[first + i]));
    if (this.planar) return { place, turn: new Quaternion().setFromAxisAngle(this.across, path[first + 2]) };
    return { place, turn: new Quaternion(path[first + 4], path[first + 5], path[first + 6], path[first + 3]).normalize() };
  }

  /** Where a body is at time t; undefined where the run has no finite number. */
  poseAt(name: string, t: number): Pose | undefined {
    const { times } = this.run;
    const row = rowAt(times, t);
    const from = this.poseInRow(name, row);
    const to = from && row + 1 < times.length ? this.poseInRow(name, row + 1) : undefined;
    if (!from || !to) return from;
    const share = Math.min(Math.max((t - times[row]) / (times[row + 1] - times[row]), 0), 1);
    from.place.lerp(to.place, share);
    from.turn.slerp(to.turn, share);
    return from;
  }

  anchorAt(anchor: Anchor, t: number): Vec3 | undefined {
    if ("fixed" in anchor) return anchor.fixed;
    if ("point" in anchor) return this.at(anchor.point, t);
    const pose = this.poseAt(anchor.body.body, t);
    return pose && carried(pose, anchor.body.at).toArray();
  }
}
