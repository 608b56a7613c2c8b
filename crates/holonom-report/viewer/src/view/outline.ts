// How far a body reaches: a few places which the whole of it lies between.

import { Quaternion, Vector3 } from "three";
import type { Body, Shape, Vec3 } from "../payload";

export interface Outline {
  /** In body axes from the centre of mass. */
  places: Vec3[];
  /** The body reaches this much farther around each of them. */
  round: number;
}

const known = new WeakMap<Body, Outline>();

/** `plane`: see `Motion.plane`. */
export function outline(body: Body, plane: Quaternion): Outline {
  let found = known.get(body);
  if (!found) {
    const { places, round } = body.shape ? ofShape(body.shape) : { places: [...body.places, [0, 0, 0] as Vec3], round: 0 };
    const turned = body.shape ? places.map((place) => new Vector3(...place).applyQuaternion(plane).toArray()) : places;
    found = { places: turned, round };
    known.set(body, found);
  }
  return found;
}

/** The largest distance between two of its places, roughly. */
export function extent({ places, round }: Outline): number {
  const spans = [0, 1, 2].map((i) => spread(places.map((place) => place[i])));
  return Math.hypot(...spans) + 2 * round;
}

function ofShape(shape: Shape): Outline {
  switch (shape.kind) {
    case "box":
      return { places: corners(shape.size.map((edge) => -edge / 2) as Vec3, shape.size.map((edge) => edge / 2) as Vec3), round: 0 };
    case "cylinder":
      return { places: rims(shape.radius, shape.length), round: 0 };
    case "sphere":
      return { places: [[0, 0, 0]], round: shape.radius };
    case "rod":
      return { places: [[-shape.length / 2, 0, 0], [shape.length / 2, 0, 0]], round: 0 };
    case "capsule":
      return { places: [[0, 0, -shape.length / 2], [0, 0, shape.length / 2]], round: shape.radius };
    case "mesh":
      return { places: shape.vertices.length > 0 ? boxAround(shape.vertices) : [[0, 0, 0]], round: 0 };
  }
}

function rims(radius: number, length: number): Vec3[] {
  const around = Array.from({ length: 12 }, (_, i) => (2 * Math.PI * i) / 12);
  return around.flatMap((angle) => [-0.5, 0.5].map((end): Vec3 => [radius * Math.cos(angle), radius * Math.sin(angle), end * length]));
}

function boxAround(vertices: Vec3[]): Vec3[] {
  const low: Vec3 = [...vertices[0]];
  const high: Vec3 = [...vertices[0]];
  for (const vertex of vertices) {
    for (let i = 0; i < 3; i++) {
      low[i] = Math.min(low[i], vertex[i]);
      high[i] = Math.max(high[i], vertex[i]);
    }
  }
  return corners(low, high);
}

function corners(low: Vec3, high: Vec3): Vec3[] {
  return Array.from({ length: 8 }, (_, corner): Vec3 => [0, 1, 2].map((i) => ((corner >> i) & 1 ? high[i] : low[i])) as Vec3);
}

function spread(values: number[]): number {
  return Math.max(...values) - Math.min(...values);
}
