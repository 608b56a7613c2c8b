// The ground: below a mechanism in space, behind one in a plane.

import { Box3, BufferGeometry, Float32BufferAttribute, LineBasicMaterial, LineSegments, Vector3 } from "three";
import type { Viewpoint } from "./camera";
import { diagonal } from "./frame";

export interface Grid {
  object: LineSegments<BufferGeometry, LineBasicMaterial>;
  /** Edge of a cell, m. */
  cell: number;
  /** Goes with what has come so far, by whole cells: lines stay where they are. */
  follow(way: Vector3): void;
}

/** `level`: of the ground in space, along `view.up`; `origin`: see `Run.origin`. */
export function buildGrid(view: Viewpoint, box: Box3, level: number, origin: Vector3): Grid {
  const size = diagonal(box);
  const cell = roundNumber(size / 9);
  const normal = view.planar ? view.towards : view.up;
  const [across, along] = [new Vector3(1, 0, 0), new Vector3(0, 1, 0), new Vector3(0, 0, 1)].filter((axis) => Math.abs(axis.dot(normal)) < 0.5);
  const center = box.getCenter(new Vector3());
  // Lines lie at whole multiples of the cell in the world.
  const snap = (axis: Vector3): number => Math.round((center.dot(axis) + origin.dot(axis)) / cell) * cell - origin.dot(axis);
  const height = view.planar ? center.dot(normal) - 0.05 * size : level;
  const cells = view.planar ? Math.ceil((1.6 * size) / cell) : Math.ceil((0.75 * size) / cell);
  const points: number[] = [];
  const add = (u: number, v: number): void => {
    const point = new Vector3().addScaledVector(across, snap(across) + u * cell).addScaledVector(along, snap(along) + v * cell);
    points.push(...point.addScaledVector(normal, height).toArray());
  };
  for (let i = -cells; i <= cells; i++) {
    add(i, -cells);
    add(i, cells);
    add(-cells, i);
    add(cells, i);
  }
  const geometry = new BufferGeometry().setAttribute("position", new Float32BufferAttribute(points, 3));
  const object = new LineSegments(geometry, new LineBasicMaterial({ depthWrite: false }));
  object.renderOrder = -2; // under everything
  const follow = (way: Vector3): void => {
    object.position.set(0, 0, 0);
    for (const axis of [across, along]) object.position.addScaledVector(axis, Math.round(way.dot(axis) / cell) * cell);
  };
  return { object, cell, follow };
}

/** The nearest of 1, 2, 5 · 10ᵏ. */
function roundNumber(size: number): number {
  const power = 10 ** Math.floor(Math.log10(size));
  const share = size / power;
  return power * (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10);
}
