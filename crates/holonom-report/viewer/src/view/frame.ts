// The part of space in which everything happens: what the camera has to show.

import { Box3, Vector3 } from "three";
import type { Motion } from "../motion";
import type { Vec3 } from "../payload";

/** Rows looked at per run; a box needs no more. */
const SAMPLES = 400;
/** A run that blew up must not shrink the mechanism to a dot: beyond this many starting sizes, the outermost rows are left out. */
const FAR = 30;

export function boundingBox(motions: Motion[]): Box3 {
  const fixed = motions.flatMap(fixedPlaces);
  const start = boxOf([...fixed, ...motions.flatMap((motion) => placesInRow(motion, 0))]);
  const places = motions.flatMap(allPlaces);
  let box = boxOf([...fixed, ...places]);
  if (diagonal(box) > FAR * Math.max(diagonal(start), 1e-9)) box = boxOf([...fixed, ...innermost(places, 0.9)]);
  return withSize(box);
}

export function diagonal(box: Box3): number {
  return box.isEmpty() ? 0 : box.getSize(new Vector3()).length();
}

function fixedPlaces(motion: Motion): Vec3[] {
  return motion.run.scene.lines.flatMap((line) => [line.from, line.to].flatMap((end) => ("fixed" in end ? [end.fixed] : [])));
}

function placesInRow(motion: Motion, row: number): Vec3[] {
  return motion.run.scene.points.map((point) => motion.inRow(point.name, row)).filter((place) => place !== undefined);
}

function allPlaces(motion: Motion): Vec3[] {
  const rows = motion.run.times.length;
  const step = Math.max(1, Math.floor(rows / SAMPLES));
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
