// Ranges and ticks of the axes.

import uPlot from "uplot";
import { power, ticks } from "../format";

/** A range that is a smaller share of its values is one value: between its ends there are no numbers for ticks. */
const ROUNDING = 1e-12;

/** The lower and the upper end. */
export type Range = [number, number];

/** What is smaller than this is zero to a computer. */
const FLOOR = 1e-18;

/** A logarithmic axis has no zero: zeros are drawn at the lower end of the decade of the smallest value. */
export function logFloor(values: Iterable<number>): number {
  let smallest = Infinity;
  for (const value of values) if (value > 0 && value < smallest) smallest = value;
  return Number.isFinite(smallest) ? Math.max(FLOOR, decade(smallest)) : FLOOR;
}

/** Whole decades around a range. */
export function logAxis(range: Range | undefined): Range {
  if (!range || !(range[1] > 0)) return [FLOOR, 1];
  const [min, max] = [Math.max(range[0], FLOOR), Math.max(range[1], FLOOR)];
  const low = decade(min);
  let high = decade(max);
  if (high < max * 0.999) high *= 10;
  return high / low < 50 ? [low / 10, high * 10] : [low, high];
}

/** A range with margins, never narrower than `leastSpan`. */
export function linearAxis(range: Range | undefined, leastSpan: number, fromZero: boolean): Range {
  if (!range) return [0, 1];
  const [min, max] = range;
  if (fromZero) return [0, Math.max(1, max) * 1.1];
  const size = Math.max(Math.abs(min), Math.abs(max));
  const wanted = Math.max(max - min, leastSpan);
  const span = wanted > ROUNDING * size ? wanted : 0.1 * size || 1;
  const missing = span - (max - min);
  const margin = 0.07 * span + missing / 2;
  return [min - margin, max + margin];
}

/** Whole decades, no more labels than fit. */
export function logSplits(_: uPlot, __: number, min: number, max: number): number[] {
  const [low, high] = [exponent(min), exponent(max)];
  const step = Math.max(1, Math.ceil((high - low) / 5));
  const splits: number[] = [];
  for (let e = Math.ceil(low / step) * step; e <= high; e += step) splits.push(10 ** e);
  return splits;
}

export function logLabels(_: uPlot, splits: number[]): string[] {
  return splits.map((value) => power(exponent(value)));
}

/** Ticks of a linear axis that are so many px apart at least. uPlot's own are none where they would be less than 1e-16 or more than 1e32 apart. */
export function linearTicks(space: number): Pick<uPlot.Axis, "space" | "incrs" | "splits" | "values"> {
  let increment = 1;
  return {
    space,
    // One that it takes for any axis: how much room that has tells how long the axis is.
    incrs: (_, __, min, max) => [Math.max(5, max - min)],
    splits: (_, __, min, max, taken, room) => {
      increment = roundUp((taken / room) * space);
      const first = Math.ceil(min / increment);
      // No zero is negative.
      return Array.from({ length: Math.floor(max / increment) - first + 1 }, (_, k) => (first + k) * increment + 0);
    },
    values: (_, splits) => ticks(splits, increment),
  };
}

/** The least of 1, 2, 2.5 and 5 times a power of ten that is no less. */
function roundUp(value: number): number {
  const power = Math.floor(Math.log10(value));
  const found = [1, 2, 2.5, 5, 10].map((first) => Number(`${first}e${power}`)).find((increment) => increment >= value);
  return found ?? Number(`1e${power + 1}`);
}

export function linearLabels(_: uPlot, splits: number[], __: number, ___: number, increment: number): string[] {
  return ticks(splits, increment);
}

function exponent(value: number): number {
  return Math.round(Math.log10(value));
}

function decade(value: number): number {
  return 10 ** Math.floor(Math.log10(value) + 1e-9);
}
