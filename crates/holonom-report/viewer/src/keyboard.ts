// The space bar plays and pauses, the arrow keys go from row to row.

import type { Clock } from "./clock";
import { rowAt } from "./motion";

/** Where keys belong to what is written or chosen. */
const FIELDS = "input:not([type=range]), textarea, select, [contenteditable]";
/** What the space bar presses, as everywhere. */
const PRESSED = "button, summary, a[href]";

/** `times`: of the rows that the arrow keys stop at, s. */
export function listenToKeys(clock: Clock, times: Float64Array): void {
  document.addEventListener("keydown", (event) => {
    const target = event.target instanceof Element ? event.target : document.body;
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey || event.shiftKey || target.closest(FIELDS)) return;
    if (event.key === " ") {
      if (target.closest(PRESSED)) return;
      if (!event.repeat) clock.toggle();
    } else if (event.key === "ArrowRight" || event.key === "ArrowLeft") {
      clock.pause();
      clock.setTime(event.key === "ArrowRight" ? next(times, clock.time) : previous(times, clock.time));
    } else return;
    // Neither scrolls the page nor moves the slider.
    event.preventDefault();
  });
}

function next(times: Float64Array, t: number): number {
  const row = rowAt(times, t);
  return times[times[row] > t ? row : Math.min(row + 1, times.length - 1)] ?? t;
}

function previous(times: Float64Array, t: number): number {
  const row = rowAt(times, t);
  return times[times[row] < t ? row : Math.max(row - 1, 0)] ?? t;
}
