// The solids of bodies that have a shape, and the lines that make their form and their turning visible.

import { BoxGeometry, BufferGeometry, CapsuleGeometry, CylinderGeometry, EdgesGeometry, Float32BufferAttribute, SphereGeometry } from "three";
import { toCreasedNormals } from "three/addons/utils/BufferGeometryUtils.js";
import type { Shape } from "../payload";

export interface Solid {
  surface: BufferGeometry;
  edges: BufferGeometry | undefined;
}

/** Faces that meet at more than this angle have an edge between them, degrees. */
const SHARP = 30;
/** A finer mesh has its form from shading alone. */
const MOST_TRIANGLES = 60_000;

/** `thin`: radius of what has none. */
export function solidOf(shape: Shape, thin: number): Solid {
  switch (shape.kind) {
    case "box":
      return edged(new BoxGeometry(...shape.size.map((edge) => edge || thin)));
    case "cylinder":
      return cylinder(shape.radius, shape.length || thin);
    case "sphere":
      return { surface: new SphereGeometry(shape.radius, 40, 24), edges: lines(...greatCircles(shape.radius)) };
    case "rod":
      return { surface: new CapsuleGeometry(thin, shape.length, 8, 20).rotateZ(Math.PI / 2), edges: undefined };
    case "capsule":
      return capsule(shape.radius, shape.length);
    case "mesh":
      return mesh(shape);
  }
}

export function edged(surface: BufferGeometry): Solid {
  return { surface, edges: new EdgesGeometry(surface, SHARP) };
}

function cylinder(radius: number, length: number): Solid {
  const surface = new CylinderGeometry(radius, radius, length, 48).rotateX(Math.PI / 2);
  const [low, high] = [-length / 2, length / 2];
  // A cross on either end and a line along the side show how it turns.
  const cross = [low, high].flatMap((z) => [[[-radius, 0, z], [radius, 0, z]], [[0, -radius, z], [0, radius, z]]]);
  const side = [[[radius, 0, low], [radius, 0, high]], [[-radius, 0, low], [-radius, 0, high]]];
  return { surface, edges: lines(circle(radius, "z", low), circle(radius, "z", high), ...cross, ...side) };
}

function capsule(radius: number, length: number): Solid {
  const surface = new CapsuleGeometry(radius, length, 14, 40).rotateX(Math.PI / 2);
  const meridian = (x: number, y: number): number[][] => {
    const end = (sign: number): number[][] =>
      Array.from({ length: 25 }, (_, i) => {
        const angle = (Math.PI * i) / 24;
        const out = radius * Math.cos(angle) * sign;
        return [x * out, y * out, sign * (length / 2 + radius * Math.sin(angle))];
      });
    const path = [...end(1), ...end(-1)];
    return [...path, path[0]];
  };
  return { surface, edges: lines(circle(radius, "z", -length / 2), circle(radius, "z", length / 2), meridian(1, 0), meridian(0, 1)) };
}

function mesh({ vertices, triangles }: Shape & { kind: "mesh" }): Solid {
  const indexed = new BufferGeometry().setAttribute("position", new Float32BufferAttribute(vertices.flat(), 3));
  indexed.setIndex(triangles.flat());
  if (triangles.length === 0) return { surface: indexed, edges: undefined };
  if (triangles.length > MOST_TRIANGLES) {
    indexed.computeVertexNormals();
    return { surface: indexed, edges: undefined };
  }
  return { surface: toCreasedNormals(indexed, (SHARP * Math.PI) / 180), edges: new EdgesGeometry(indexed, SHARP) };
}

function greatCircles(radius: number): number[][][] {
  return [circle(radius, "x", 0), circle(radius, "y", 0), circle(radius, "z", 0)];
}

function circle(radius: number, axis: "x" | "y" | "z", level: number): number[][] {
  const turn = { x: 0, y: 1, z: 2 }[axis];
  return Array.from({ length: 65 }, (_, i) => {
    const angle = (2 * Math.PI * i) / 64;
    const place = [level, radius * Math.cos(angle), radius * Math.sin(angle)];
    return [0, 1, 2].map((k) => place[(k - turn + 3) % 3]);
  });
}

/** Paths as separate pieces, which is how edges are drawn. */
function lines(...paths: number[][][]): BufferGeometry {
  const pieces = paths.flatMap((path) => path.slice(1).flatMap((place, i) => [...path[i], ...place]));
  return new BufferGeometry().setAttribute("position", new Float32BufferAttribute(pieces, 3));
}
