// Curves as straight lines from row to row. Where rows are dense, those that uPlot has go by columns of pixels, which gives stairs; and they
// go by ascending values of x, which the path of one column over another does not.

import uPlot from "uplot";

/** Rows that a curve has no value for are passed over, and nulls leave gaps. */
export function straight(plot: uPlot, index: number): uPlot.Series.Paths {
  const stroke = new Path2D();
  uPlot.orient(plot, index, (_, across, y, scaleX, scaleY, toX, toY, left, top, width, height, moveTo, lineTo) => {
    let drawn = false;
    for (let row = 0; row < y.length; row++) {
      const [u, v] = [across[row], y[row]];
      if (v === undefined) continue;
      if (u === null || u === undefined || v === null) {
        drawn = false;
        continue;
      }
      (drawn ? lineTo : moveTo)(stroke, toX(u, scaleX, width, left), toY(v, scaleY, height, top));
      drawn = true;
    }
  });
  return { stroke, fill: null as unknown as Path2D, clip: null as unknown as Path2D, flags: 0 } as uPlot.Series.Paths;
}
