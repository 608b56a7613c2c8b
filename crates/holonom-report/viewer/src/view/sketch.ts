// Bodies without a shape: a flat link where everything lies in one plane, round bars otherwise.

import { BufferGeometry, CapsuleGeometry, Quaternion, SphereGeometry, Vector3 } from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";
import { plate } from "./plate";
import { edged, type Solid } from "./solid";

const UP = new Vector3(0, 1, 0);
const CENTRE = new Vector3();

/** What a sketch is made with, m. */
export interface Pen {
  /** The width of things; nearer than half of it is the same place. */
  unit: number;
  /** Of flat links. */
  thickness: number;
}

/** `normal`: the direction that the joints of the body turn about, if they have one in common. */
export function sketch(all: Vector3[], normal: Vector3 | undefined, pen: Pen): Solid {
  const places = distinct(all, pen.unit / 2);
  const spots = withCentre(places, pen.unit);
  const flat = normal && isFlat(places, normal, pen.unit) ? normal : normalOf(places, pen.unit);
  if (spots.length === 1) return flat ? edged(plate(spots, flat, (all.length > 0 ? 1.35 : 2) * pen.unit, pen.thickness)) : ball((all.length > 0 ? 1.25 : 1.8) * pen.unit);
  if (flat) return edged(plate(spots, flat, 1.35 * pen.unit, pen.thickness));
  return { surface: bars(places, pen.unit), edges: undefined };
}

function ball(radius: number): Solid {
  return { surface: new SphereGeometry(radius, 28, 20), edges: undefined };
}

/** One place is joined with the centre of mass, two with each other, more each with the centre. */
function bars(places: Vector3[], unit: number): BufferGeometry {
  const radius = 0.8 * unit;
  const parts: BufferGeometry[] = [];
  const ends = farthest(places);
  if (ends && places.every((place) => distanceToLine(place, ends) < unit / 2)) {
    parts.push(bar(...ends, radius));
    const foot = nearestOn(CENTRE, ends);
    if (foot.length() > radius) parts.push(bar(foot, CENTRE, 0.7 * radius));
  } else {
    for (const place of places) parts.push(bar(CENTRE, place, radius));
  }
  if (places.length === 1) parts.push(new SphereGeometry(2 * unit, 28, 20));
  return mergeGeometries(parts);
}

function bar(from: Vector3, to: Vector3, radius: number): BufferGeometry {
  const along = new Vector3().subVectors(to, from);
  const length = along.length();
  const turn = new Quaternion().setFromUnitVectors(UP, along.divideScalar(length || 1));
  const middle = new Vector3().addVectors(from, to).divideScalar(2);
  return new CapsuleGeometry(radius, length, 6, 20).applyQuaternion(turn).translate(middle.x, middle.y, middle.z);
}

/** The centre of mass belongs to the outline unless it lies on the line between two places. */
function withCentre(places: Vector3[], unit: number): Vector3[] {
  const ends = farthest(places);
  return ends && nearestOn(CENTRE, ends).length() < unit ? places : distinct([...places, CENTRE], unit / 2);
}

function distinct(places: Vector3[], tolerance: number): Vector3[] {
  return places.filter((place, i) => places.findIndex((other) => other.distanceTo(place) <= tolerance) === i);
}

function isFlat(places: Vector3[], normal: Vector3, unit: number): boolean {
  return [...places, CENTRE].every((place) => Math.abs(place.dot(normal)) < unit / 2);
}

/** Of the plane through three or more places and the centre, if there is just one. */
function normalOf(places: Vector3[], unit: number): Vector3 | undefined {
  const ends = farthest(places);
  if (!ends || places.length < 3) return undefined;
  const corner = places.reduce((best, place) => (distanceToLine(place, ends) > distanceToLine(best, ends) ? place : best));
  if (distanceToLine(corner, ends) < unit) return undefined;
  const normal = new Vector3().subVectors(ends[1], ends[0]).cross(new Vector3().subVectors(corner, ends[0])).normalize();
  return [...places, CENTRE].every((place) => Math.abs(new Vector3().subVectors(place, corner).dot(normal)) < unit / 2) ? normal : undefined;
}

function farthest(places: Vector3[]): [Vector3, Vector3] | undefined {
  if (places.length < 2) return undefined;
  const from = places.reduce((best, place) => (place.distanceTo(places[0]) > best.distanceTo(places[0]) ? place : best));
  const to = places.reduce((best, place) => (place.distanceTo(from) > best.distanceTo(from) ? place : best));
  return [from, to];
}

function nearestOn(place: Vector3, [from, to]: [Vector3, Vector3]): Vector3 {
  const along = new Vector3().subVectors(to, from);
  const share = new Vector3().subVectors(place, from).dot(along) / along.lengthSq();
  return from.clone().addScaledVector(along, Math.min(Math.max(share, 0), 1));
}

function distanceToLine(place: Vector3, ends: [Vector3, Vector3]): number {
  return nearestOn(place, ends).distanceTo(place);
}
