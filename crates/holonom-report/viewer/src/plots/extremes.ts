// A table of what the plotted columns reach.

import type { Clock } from "../clock";
import { element } from "../dom";
import { cleared, reading, readingBetween } from "../format";
import type { Channel, Run } from "../payload";
import { withUnit } from "./charts";

export class Extremes {
  readonly node = element("details", { class: "extremes", open: "" }, element("summary", {}, "Extremes of what is plotted"));
  private readonly body = element("tbody");

  constructor(private readonly runs: Run[], private readonly clock: Clock) {
    const heads = ["", "min", "max"].map((head) => element("th", { scope: "col", class: head ? "number" : "" }, head));
    const table = element("table", {}, element("thead", {}, element("tr", {}, ...heads)), this.body);
    this.node.append(table);
  }

  show(columns: string[]): void {
    this.body.replaceChildren(...columns.flatMap((column) => this.runs.flatMap((run) => this.row(run, column))));
    this.node.hidden = this.body.childElementCount === 0;
  }

  private row(run: Run, column: string): HTMLElement[] {
    const channel = run.channelOf.get(column);
    if (!channel?.extremes) return [];
    const [least, leastAt, most, mostAt] = channel.extremes;
    const name = withUnit(column, channel.unit === "1" ? "" : channel.unit);
    const beside = largest(run, channel);
    const cell = (value: number, t: number): HTMLElement => {
      const text = readingBetween(cleared(value, beside), least, most);
      return element("td", { class: "number" }, element("span", {}, text), " ", this.at(t));
    };
    const head = element("th", { scope: "row" }, this.runs.length > 1 ? `${name}, ${run.label}` : name);
    return [element("tr", {}, head, cell(least, leastAt), cell(most, mostAt))];
  }

  /** A time, which the page goes to when it is clicked. */
  private at(t: number): HTMLElement {
    const button = element("button", { type: "button", title: "show this moment" }, `${reading(t)} s`);
    button.addEventListener("click", () => this.clock.setTime(t));
    return button;
  }
}

/** The largest magnitude of a column, or of all of its unit: components of one force, and forces of one mechanism, have one round-off. What a model measures is its own scale. */
function largest(run: Run, channel: Channel): number {
  const isLike = (other: Channel): boolean => !channel.is_measure && !other.is_measure && other.unit === channel.unit;
  const alike = run.channels.filter((other) => other === channel || isLike(other));
  return Math.max(...alike.flatMap(({ extremes }) => (extremes ? [Math.abs(extremes[0]), Math.abs(extremes[2])] : [])));
}
