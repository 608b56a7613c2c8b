// The part of space in which everything happens: what the camera has to show.

import { Box3, Vector3 } from "three";
import { carried, type Motion } from "../motion";
import type { Vec3 } from "../payload";
import { outline } from "./outline";
import { poseOf, sidesOf } from "./side";
import { sidesOfWheels } from "./wheels";

/** Rows looked at per run; a box needs no more. */
const SAMPLES = 400;
/** The same times the number of bodies. */
const BODY_SAMPLES = 12_000;
/** A run that blew up must not shrink the mechanism to a dot: beyond this many starting sizes, the outermost rows are left out. */
const FAR = 30;
/** Kinds of joints whose place in the world is drawn. */
const HOLDS_PLACE = new Set(["revolute", "spherical", "universal", "fixed", "generic", "constant-velocity", "prismatic", "cylindrical", "screw"]);

export function boundingBox(motions: Motion[]): Box3 {
  const fixed = motions.flatMap(fixedPlaces);
  const start = boxAt(motions, 0);
  const places = motions.flatMap(allPlaces);
  let box = boxOf([...fixed, ...places]);
  if (diagonal(box) > FAR * Math.max(diagonal(start), 1e-9)) box = boxOf([...fixed, ...innermost(places, 0.9)]);
  box.expandByScalar(Math.max(0, ...motions.map((motion) => motion.room)) * diagonal(box));
  return withSize(box);
}

/** The room that mechanisms take in a row. */
export function boxAt(motions: Motion[], row: number): Box3 {
  return boxOf(motions.flatMap((motion) => [...fixedPlaces(motion), ...placesInRow(motion, row)]));
}

/** Whether something of a mechanism is drawn on the ground. */
export function isTied(motion: Motion): boolean {
  return fixedPlaces(motion).length > 0;
}

export function diagonal(box: Box3): number {
  return box.isEmpty() ? 0 : box.getSize(new Vector3()).length();
}

function fixedPlaces(motion: Motion): Vec3[] {
  const { lines, joints } = motion.run.scene;
  const ends = lines.flatMap((line) => [line.from, line.to].flatMap((end) => ("fixed" in end ? [end.fixed] : [])));
  const held = joints.filter(({ body }) => body === null);
  return [...ends, ...held.flatMap((joint) => [...(HOLDS_PLACE.has(joint.kind) ? [joint.at] : []), ...(joint.curve ?? [])])];
}

function placesInRow(motion: Motion, row: number): Vec3[] {
  const { points, bodies, joints } = motion.run.scene;
  const places = points.map((point) => motion.inRow(point.name, row)).filter((place) => place !== undefined);
  for (const body of bodies) {
    const pose = motion.poseInRow(body.name, row);
    if (!pose) continue;
    const { places: corners, round } = outline(body, motion.plane);
    for (const corner of corners) places.push(...ball(carried(pose, corner), round));
  }
  // Bodies without a shape have the discs that they roll on.
  const shaped = new Set(bodies.flatMap(({ name, shape }) => (shape ? [name] : [])));
  for (const joint of joints) {
    if (joint.radius === undefined || shaped.has(joint.other ?? "")) continue;
    const disc = sidesOf(motion, joint)?.[1];
    const pose = disc && poseOf(motion, disc.body, row);
    if (pose) places.push(...ball(carried(pose, disc.at.toArray()), joint.radius));
  }
  // Wheels with teeth or a belt reach beyond the places of their joints.
  for (const wheels of motion.run.scene.wheels) {
    sidesOfWheels(motion, wheels).forEach((side, k) => {
      const [pose, radius] = [side && poseOf(motion, side.body, row), wheels.radii[k]];
      if (side && pose && radius) places.push(...ball(carried(pose, side.at.toArray()), radius));
    });
  }
  // Curves go with the bodies that have them, as the groove of a cam.
  for (const { body, curve } of joints) {
    const pose = curve && body !== null ? motion.poseInRow(body, row) : undefined;
    if (curve && pose) places.push(...curve.map((place) => carried(pose, place).toArray()));
  }
  return places;
}

/** A place, or the lowest and the highest corner of what encloses a ball around it. */
function ball(centre: Vector3, radius: number): Vec3[] {
  if (radius === 0) return [centre.toArray()];
  return [centre.clone().addScalar(-radius).toArray(), centre.clone().addScalar(radius).toArray()];
}

function allPlaces(motion: Motion): Vec3[] {
  const rows = motion.run.times.length;
  const samples = Math.max(Math.min(SAMPLES, BODY_SAMPLES / Math.max(motion.run.scene.bodies.length, 1)), 20);
  const step = Math.max(1, Math.floor(rows / samples));
  const places: Vec3[] = [];
  for (let row = 0; row < rows; row += step) places.push(...placesInRow(motion, row));
  return places;
}

/** The given share of the places, without those farthest from the median. */
function innermost(places: Vec3[], share: number): Vec3[] {
  const median = [0, 1, 2].map((i) => middle(places.map((place) => place[i])));
  const distance = (place: Vec3): number => Math.hypot(...place.map((x, i) => x - median[i]));
  const finite = places.filter((place) => place.every(Number.isFinite));
  return finite.sort((a, b) => distance(a) - distance(b)).slice(0, Math.ceil(share * finite.length));
}

function middle(values: number[]): number {
  return values.filter(Number.isFinite).sort((a, b) => a - b)[values.length >> 1] ?? 0;
}

function boxOf(places: Vec3[]): Box3 {
  const box = new Box3();
  for (const place of places) if (place.every(Number.isFinite)) box.expandByPoint(new Vector3(...place));
  return box;
}

/** Not empty and not a single point. */
function withSize(box: Box3): Box3 {
  if (box.isEmpty()) box.expandByPoint(new Vector3());
  return diagonal(box) > 1e-9 ? box : box.expandByScalar(0.5);
}
