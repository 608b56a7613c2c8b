// What a plot of several runs has besides its curves: which runs leave its axis, and the values under the pointer.

import { element } from "../dom";
import { reading } from "../format";
import { curveSample } from "../sample";
import type { Visibility } from "../visibility";
import type { Departure } from "./bounds";
import type { Chart } from "./charts";
import { valueAt } from "./values";

/** Distance of the values from the pointer, px. */
const DISTANCE = 16;

/** Title, and a line that names the curves that the axis has no room for. */
export class ComparedHeading {
  readonly node: HTMLElement;
  private readonly beyond = element("p", { class: "beyond" });

  constructor(chart: Chart) {
    this.node = element("figcaption", {}, element("h3", {}, chart.title), this.beyond);
  }

  refresh(gone: Departure[]): void {
    const reach = (value: number): string => (Number.isFinite(value) ? ` (to ${reading(value)})` : "");
    const named = gone.map(({ curve, row, farthest }) => `${curve.label} from ${reading(curve.x[row])} s${reach(farthest)}`);
    this.beyond.textContent = named.length > 0 ? `beyond the axis: ${named.join(", ")}` : "";
  }
}

/** A list beside the pointer: every shown run with its value, the largest first. */
export class Readout {
  readonly node = element("div", { class: "readout", hidden: "" });

  constructor(private readonly chart: Chart, private readonly visibility: Visibility) {}

  /** At time t, for a pointer at `left` in a drawing of the given width. */
  show(t: number, left: number, width: number): void {
    const curves = this.chart.curves.filter((curve) => this.visibility.shows(curve.run) && t <= curve.x[curve.x.length - 1]);
    const rows = curves.map((curve) => ({ curve, value: valueAt(curve, t) ?? NaN }));
    rows.sort((a, b) => order(b.value) - order(a.value));
    const cells = rows.flatMap(({ curve, value }) => [
      curveSample(curve.colour),
      element("span", {}, curve.label),
      element("span", { class: "value" }, reading(value)),
    ]);
    this.node.replaceChildren(element("b", {}, `t = ${reading(t)} s`), ...cells);
    this.node.hidden = false;
    const right = left < width / 2;
    this.node.style.left = right ? `${left + DISTANCE}px` : "";
    this.node.style.right = right ? "" : `${width - left + DISTANCE}px`;
  }

  hide(): void {
    this.node.hidden = true;
  }
}

function order(value: number): number {
  return Number.isFinite(value) ? value : Infinity;
}
