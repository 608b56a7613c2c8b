// Title of a plot with the values of its curves: switches where it holds several curves of one run.

import { element } from "../dom";
import { cleared, reading } from "../format";
import { curveColor } from "../theme";
import { withUnit, type Chart, type Curve } from "./charts";
import { valueAt } from "./values";

export class Heading {
  readonly node: HTMLElement;
  onToggle = (): void => {};
  private readonly entries: HTMLElement[];
  private readonly values: HTMLElement[];
  /** The largest magnitude of each curve. */
  private readonly largest: number[];

  constructor(private readonly chart: Chart) {
    const larger = (most: number, value: number): number => (Number.isFinite(value) ? Math.max(most, Math.abs(value)) : most);
    this.largest = chart.curves.map((curve) => curve.y.reduce(larger, 0));
    this.values = chart.curves.map(() => element("span", { class: "value" }));
    const several = chart.curves.length > 1;
    this.entries = chart.curves.map((curve, i) => (several ? this.entrySwitch(curve, i) : element("span", { class: "entry" }, this.values[i])));
    this.node = element("figcaption", {}, element("h3", {}, withUnit(chart.title, chart.unit)), element("div", { class: "entries" }, ...this.entries));
  }

  show(t: number): void {
    this.chart.curves.forEach((curve, i) => {
      const value = valueAt(curve, t);
      this.values[i].textContent = reading(value === undefined ? value : cleared(value, this.largest[i]));
    });
  }

  refresh(): void {
    this.chart.curves.forEach((curve, i) => {
      const entry = this.entries[i];
      const swatch = entry.querySelector<HTMLElement>(".swatch");
      if (swatch) swatch.style.background = curveColor(curve.colour);
      if (entry instanceof HTMLButtonElement) entry.setAttribute("aria-pressed", String(curve.shown));
    });
  }

  private entrySwitch(curve: Curve, i: number): HTMLElement {
    const button = element("button", { type: "button", class: "entry" }, element("span", { class: "swatch" }), curve.label, this.values[i]);
    button.addEventListener("click", () => {
      curve.shown = !curve.shown;
      this.onToggle();
    });
    return button;
  }
}
