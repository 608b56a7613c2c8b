// What a curve is at a time.

import { rowAt } from "../motion";
import type { Curve } from "./charts";

/** The row nearest in time. */
export function rowNear(curve: Curve, t: number): number {
  const row = rowAt(curve.x, t);
  const next = Math.min(row + 1, curve.x.length - 1);
  return curve.x[next] - t < t - curve.x[row] ? next : row;
}

/** The value of that row. */
export function valueAt(curve: Curve, t: number): number | undefined {
  return curve.y[rowNear(curve, t)];
}
