// What a curve is at a time.

import { rowAt } from "../motion";
import type { Curve } from "./charts";

/** The value of the nearest row; none before the first and after the last. */
export function valueAt(curve: Curve, t: number): number | undefined {
  const row = rowAt(curve.x, t);
  const next = Math.min(row + 1, curve.x.length - 1);
  return curve.y[curve.x[next] - t < t - curve.x[row] ? next : row];
}
