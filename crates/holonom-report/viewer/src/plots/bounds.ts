// How far an axis reaches when some run blows up.

import type { Run } from "../payload";

/** What a curve covers. */
export interface Extent {
  min: number;
  max: number;
  sound: boolean;
}

/** A logarithmic axis has room for so many powers of ten above the sound runs. */
const DECADES_ABOVE = 12;

/** Numbers beyond this cannot be drawn. */
const LARGEST_DRAWN = 1e30;

/** Common range of the sound curves, and of the others as far as they do not flatten them; of all, if none is sound. */
export function linearBounds(extents: Extent[], allowed: number): [number, number] | undefined {
  const { sound, others } = parted(extents);
  const range = span(sound);
  if (!range) return span(others);
  const [low, high] = range;
  const room = Math.max(allowed, high - low);
  const near = others.filter((extent) => extent.min >= low - room && extent.max <= high + room);
  return span([...sound, ...near]);
}

/** As `linearBounds`; on a logarithmic axis there is room for much more. */
export function logBounds(extents: Extent[]): [number, number] | undefined {
  const { sound, others } = parted(extents);
  const range = span([...sound, ...others]);
  const top = sound.length > 0 ? span(sound)![1] : Math.min(...others.map((extent) => extent.max));
  return range && [range[0], Math.min(range[1], top * 10 ** DECADES_ABOVE)];
}

/** How much energy goes back and forth in the mechanism, J: the least of what sound runs say, as errors only add to it. */
export function energyMoved(runs: Run[]): number {
  const sound = runs.filter((run) => run.sound);
  const most = (sound.length > 0 ? sound : runs).map((run) => {
    const kinetic = (run.columns.get("kinetic") ?? new Float64Array()).filter(Number.isFinite);
    return kinetic.reduce((most, e) => Math.max(most, e), 0);
  });
  return most.length > 0 ? Math.min(...most) : 0;
}

/** A value that a canvas can draw. */
export function drawable(value: number): number {
  return Math.min(Math.max(value, -LARGEST_DRAWN), LARGEST_DRAWN);
}

function parted(extents: Extent[]): { sound: Extent[]; others: Extent[] } {
  return { sound: extents.filter((extent) => extent.sound), others: extents.filter((extent) => !extent.sound) };
}

function span(extents: Extent[]): [number, number] | undefined {
  if (extents.length === 0) return undefined;
  return [Math.min(...extents.map((extent) => extent.min)), Math.max(...extents.map((extent) => extent.max))];
}
