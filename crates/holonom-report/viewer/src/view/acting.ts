// Which forces and moments act on what, as far as they are recorded.

import { Vector3 } from "three";
import { carried, rowAt, type Motion } from "../motion";
import type { Anchor, Joint, Line, Run } from "../payload";
import { ownersOf, type Item } from "../selection";
import { poseOf, sidesOf, type Side } from "./side";

/** A force or moment on one side of what exerts it. */
export interface Acting {
  /** Of the joint, force or drive. */
  name: string;
  unit: "N" | "N·m";
  /** The body or point that it acts on; null: the world. */
  on: string | null;
  /** Whether its columns are those of this side. */
  recorded: boolean;
  at: (t: number) => Vector3 | undefined;
  /** In the world. */
  vector: (t: number) => Vector3 | undefined;
}

/** Kinds of joints whose first coordinate is about or along their axis. */
const ALONG_AXIS = new Set(["revolute", "prismatic", "cylindrical"]);
const PULLS = new Set(["spring", "rope", "cylinder"]);

/** On a body or point all that acts on it; of a joint what it does to its second side; of a spring what it does at its ends. */
export function actingOn(motion: Motion, item: Item): Acting[] {
  const all = everything(motion);
  if (item.sort === "body" || item.sort === "point") return [...all.filter(({ on }) => on === item.name), ...weight(motion, item.name)];
  const owners = ownersOf(item, [motion.run.scene]);
  return all.filter(({ name, recorded }) => recorded && owners.includes(name));
}

function everything(motion: Motion): Acting[] {
  const { joints, lines, loads } = motion.run.scene;
  return [
    ...joints.flatMap((joint) => ofJoint(motion, joint)),
    ...lines.filter(({ kind }) => PULLS.has(kind)).flatMap((line) => ofLine(motion, line)),
    ...loads.flatMap(({ name, at }) => {
      const place = (t: number): Vector3 | undefined => vectorOf(motion.anchorAt(at, t));
      return recordedVectors(motion, name).map(({ unit, vector }) => ({ name, unit, on: ownerOf(at), recorded: true, at: place, vector }));
    }),
  ];
}

function ofJoint(motion: Motion, joint: Joint): Acting[] {
  const sides = sidesOf(motion, joint);
  if (!sides) return [];
  const second = sides[joint.acts_on_other ? 1 : 0];
  const first = sides[joint.acts_on_other ? 0 : 1];
  const at = (t: number): Vector3 | undefined => placeOf(motion, second, t);
  const own = recordedVectors(motion, joint.name).map((recorded) => ({ name: joint.name, ...recorded }));
  const driven = ALONG_AXIS.has(joint.kind) ? joint.drives.flatMap((name) => ofDrive(motion, name, sides[0])) : [];
  return [...own, ...driven].flatMap(({ name, unit, vector }) => [
    { name, unit, on: second.body, recorded: true, at, vector },
    { name, unit, on: first.body, recorded: false, at, vector: (t: number) => vector(t)?.negate() },
  ]);
}

/** What a drive does along the axis of the side that carries it. */
function ofDrive(motion: Motion, name: string, carrier: Side): Pick<Acting, "name" | "unit" | "vector">[] {
  const effort = column(motion.run, `${name}.effort`);
  if (!effort) return [];
  const unit = effort.unit === "N" ? "N" : "N·m";
  const vector = (t: number): Vector3 | undefined => {
    const pose = poseAt(motion, carrier.body, t);
    return pose && carrier.axis.clone().applyQuaternion(pose.turn).multiplyScalar(effort.at(t));
  };
  return [{ name, unit, vector }];
}

/** Tension pulls both ends together; the effort of a driven distance pushes them apart. */
function ofLine(motion: Motion, { name, from, to, along }: Line): Acting[] {
  const [tension, effort] = [column(motion.run, `${name}.force`), column(motion.run, `${name}.effort`)];
  const pull = tension ?? effort;
  if (!pull) return [];
  const sign = tension ? 1 : -1;
  const towards = (t: number): Vector3 | undefined => {
    if (along) {
      const axis = new Vector3(...along.axis);
      return along.body === null ? axis : axis.applyQuaternion(motion.poseAt(along.body, t)?.turn ?? motion.plane);
    }
    const [a, b] = [motion.anchorAt(from, t), motion.anchorAt(to, t)];
    return a && b && new Vector3(...b).sub(new Vector3(...a)).normalize();
  };
  const end = (anchor: Anchor, side: number): Acting => ({
    name,
    unit: "N",
    on: ownerOf(anchor),
    recorded: true,
    at: (t) => vectorOf(motion.anchorAt(anchor, t)),
    vector: (t) => towards(t)?.multiplyScalar(side * sign * pull.at(t)),
  });
  return [end(from, 1), end(to, -1)];
}

function weight(motion: Motion, name: string): Acting[] {
  const { bodies, points, gravity } = motion.run.scene;
  const mass = [...bodies, ...points].find((owner) => owner.name === name)?.mass ?? 0;
  const force = new Vector3(...gravity).multiplyScalar(mass);
  const at = (t: number): Vector3 | undefined => poseAt(motion, name, t)?.place;
  return force.length() > 0 ? [{ name: "weight", unit: "N", on: name, recorded: false, at, vector: () => force.clone() }] : [];
}

/** The force of columns NAME.fx, … and the moment of NAME.tx, …, in a plane NAME.t. */
function recordedVectors(motion: Motion, name: string): Pick<Acting, "unit" | "vector">[] {
  const axes = [...motion.run.scene.axes];
  const of = (letter: string): ((t: number) => Vector3) | undefined => {
    const columns = axes.map((axis) => column(motion.run, `${name}.${letter}${axis}`));
    if (columns.some((found) => !found)) return undefined;
    return (t) => {
      const vector = new Vector3();
      axes.forEach((axis, i) => vector.setComponent("xyz".indexOf(axis), columns[i]!.at(t)));
      return vector;
    };
  };
  const turning = motion.planar ? column(motion.run, `${name}.t`) : undefined;
  const force = of("f");
  const moment = turning ? (t: number): Vector3 => motion.across.clone().multiplyScalar(turning.at(t)) : of("t");
  return [...(force ? [{ unit: "N" as const, vector: force }] : []), ...(moment ? [{ unit: "N·m" as const, vector: moment }] : [])];
}

/** A column, between its rows on a straight line. */
function column(run: Run, name: string): { unit: string; at: (t: number) => number } | undefined {
  const channel = run.channelOf.get(name);
  if (!channel) return undefined;
  const { times } = run;
  const at = (t: number): number => {
    const row = rowAt(times, t);
    const next = Math.min(row + 1, times.length - 1);
    const share = next > row ? Math.min(Math.max((t - times[row]) / (times[next] - times[row]), 0), 1) : 0;
    return (1 - share) * channel.values[row] + share * channel.values[next];
  };
  return { unit: channel.unit, at };
}

function placeOf(motion: Motion, side: Side, t: number): Vector3 | undefined {
  const pose = poseAt(motion, side.body, t);
  return pose && carried(pose, side.at.toArray());
}

/** As `poseOf`, at a time. */
function poseAt(motion: Motion, body: string | null, t: number): ReturnType<typeof poseOf> {
  const point = body === null ? undefined : motion.at(body, t);
  if (body === null || point) return point ? { place: new Vector3(...point), turn: motion.plane.clone().identity() } : poseOf(motion, null, 0);
  return motion.poseAt(body, t);
}

function ownerOf(anchor: Anchor): string | null {
  if ("point" in anchor) return anchor.point;
  return "body" in anchor ? anchor.body.body : null;
}

function vectorOf(place: [number, number, number] | undefined): Vector3 | undefined {
  return place && new Vector3(...place);
}
