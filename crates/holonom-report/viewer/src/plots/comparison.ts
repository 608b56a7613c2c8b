// What plots have besides their curves: of several runs, which of them leave its axis; and the values under the pointer.

import { element } from "../dom";
import { reading } from "../format";
import { curveSample } from "../sample";
import type { Visibility } from "../visibility";
import type { Departure } from "./bounds";
import { withUnit, type Chart, type Curve } from "./charts";
import { rowNear } from "./values";

/** Distance of the values from the pointer, px. */
const DISTANCE = 16;

/** Title, and a line that names the curves that the axis has no room for. */
export class ComparedHeading {
  readonly node: HTMLElement;
  private readonly beyond = element("p", { class: "beyond" });

  constructor(chart: Chart) {
    this.node = element("figcaption", {}, element("h3", {}, withUnit(chart.title, chart.unit)), this.beyond);
  }

  refresh(gone: Departure[]): void {
    const reach = (value: number): string => (Number.isFinite(value) ? ` (to ${reading(value)})` : "");
    const named = gone.map(({ curve, row, farthest }) => `${curve.label} from ${reading(curve.x[row])} s${reach(farthest)}`);
    this.beyond.textContent = named.length > 0 ? `beyond the axis: ${named.join(", ")}` : "";
  }
}

/** A list beside the pointer: the time, and every shown curve with its value, the largest first. */
export class Readout {
  readonly node = element("div", { class: "readout", hidden: "" });

  constructor(private readonly chart: Chart, private readonly visibility: Visibility) {}

  /** At time t, for a pointer at `left` in a drawing of the given width; of one curve alone, if it is given. */
  show(t: number, left: number, width: number, only?: Curve): void {
    const shown = (curve: Curve): boolean => curve.shown && this.visibility.shows(curve.run) && curve.x[0] <= t && t <= curve.x[curve.x.length - 1];
    const rows = (only ? [only] : this.chart.curves.filter(shown)).map((curve) => ({ curve, value: curve.y[rowNear(curve, t)] }));
    rows.sort((a, b) => order(b.value) - order(a.value));
    const cells = rows.flatMap(({ curve, value }) => [
      curveSample(curve.colour),
      element("span", {}, curve.label),
      element("span", { class: "value" }, this.values(curve, value, t)),
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

  private values(curve: Curve, value: number, t: number): string {
    const { unit, over } = this.chart;
    const text = `${reading(value)} ${unit}`;
    return over && curve.across ? `${text} at ${over.column} = ${reading(curve.across[rowNear(curve, t)])} ${over.unit}` : text;
  }
}

function order(value: number): number {
  return Number.isFinite(value) ? value : Infinity;
}
