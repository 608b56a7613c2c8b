// Where the points of a run are at any time, by linear interpolation between rows.

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

export class Motion {
  /** Which world axis (0–2) each recorded coordinate belongs to. */
  private readonly axes: number[];

  constructor(readonly run: Run) {
    this.axes = [...run.scene.axes].map((axis) => "xyz".indexOf(axis));
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

  anchorAt(anchor: Anchor, t: number): Vec3 | undefined {
    return "fixed" in anchor ? anchor.fixed : this.at(anchor.point, t);
  }
}
