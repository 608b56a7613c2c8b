// How far an axis reaches when some run blows up, and where such a run leaves it.

import type { Run } from "../payload";
import type { Chart, Curve } from "./charts";
import { linearAxis, logAxis, type Range } from "./scales";

/** What a curve covers. */
export interface Extent {
  min: number;
  max: number;
  sound: boolean;
}

/** A curve that an axis has no room for. */
export interface Departure {
  curve: Curve;
  /** The first row outside. */
  row: number;
  /** The value that lies farthest outside. */
  farthest: number;
}

/** A logarithmic axis has room for so many powers of ten above the sound runs. */
const DECADES_ABOVE = 12;

/** Numbers beyond so many times what an axis covers, or 1, cannot be drawn. */
const LARGEST_DRAWN = 1e30;

/** The axis of a chart for curves that cover so much. */
export function axisOf(chart: Chart, extents: Extent[]): Range {
  if (chart.scale === "log") return logAxis(logBounds(extents));
  return linearAxis(linearBounds(extents, chart.allowed), chart.leastSpan, chart.scale === "steps");
}

/** The shown curves that leave the axis of the whole run; where no run is sound, the axis has room for all. */
export function departures(chart: Chart, shown: Curve[]): Departure[] {
  if (!shown.some((curve) => curve.sound)) return [];
  const [low, high] = axisOf(chart, shown.flatMap(extentOf));
  const least = chart.scale === "log" ? -Infinity : low;
  const outside = (value: number): number => Math.max(value - high, least - value);
  return shown.flatMap((curve): Departure[] => {
    const row = curve.sound ? -1 : curve.y.findIndex((value) => outside(value) > 0);
    if (row < 0) return [];
    return [{ curve, row, farthest: curve.y.reduce((far, value) => (outside(value) > outside(far) ? value : far), curve.y[row]) }];
  });
}

/** How much energy goes back and forth in the mechanism, J: the least of what sound runs say, as errors only add to it. */
export function energyMoved(runs: Run[]): number {
  // What was measured need not have energies.
  const known = runs.flatMap(({ sound, columns }) => (columns.has("kinetic") ? [{ sound, kinetic: columns.get("kinetic")! }] : []));
  const sound = known.filter((run) => run.sound);
  const most = (sound.length > 0 ? sound : known).map(({ kinetic }) => kinetic.filter(Number.isFinite).reduce((most, e) => Math.max(most, e), 0));
  return most.length > 0 ? Math.min(...most) : 0;
}

/** The largest value of a chart that a canvas can draw. */
export function largestDrawn(chart: Chart): number {
  const ends = chart.scale === "log" ? [] : axisOf(chart, chart.curves.flatMap(extentOf));
  return LARGEST_DRAWN * Math.max(1, ...ends.map(Math.abs));
}

/** Common range of the sound curves, and of the others as far as they do not flatten them; of all, if none is sound. */
function linearBounds(extents: Extent[], allowed: number): Range | undefined {
  const { sound, others } = parted(extents);
  const range = span(sound);
  if (!range) return span(others);
  const room = Math.max(allowed, range[1] - range[0]);
  return span([...sound, ...others.filter(({ min, max }) => min >= range[0] - room && max <= range[1] + room)]);
}

/** As `linearBounds`; on a logarithmic axis there is room for much more. */
function logBounds(extents: Extent[]): Range | undefined {
  const range = span(extents);
  const top = span(parted(extents).sound)?.[1] ?? Infinity;
  return range && [range[0], Math.min(range[1], top * 10 ** DECADES_ABOVE)];
}

function parted(extents: Extent[]): { sound: Extent[]; others: Extent[] } {
  return { sound: extents.filter((extent) => extent.sound), others: extents.filter((extent) => !extent.sound) };
}

/** What the finite values of a curve cover. */
function extentOf({ y, sound }: Curve): Extent[] {
  const finite = y.filter(Number.isFinite);
  if (finite.length === 0) return [];
  return [{ min: finite.reduce((a, b) => Math.min(a, b)), max: finite.reduce((a, b) => Math.max(a, b)), sound }];
}

function span(extents: Extent[]): Range | undefined {
  if (extents.length === 0) return undefined;
  return [Math.min(...extents.map((extent) => extent.min)), Math.max(...extents.map((extent) => extent.max))];
}
