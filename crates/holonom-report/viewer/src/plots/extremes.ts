// A table of what the plotted columns reach.

import type { Clock } from "../clock";
import { element } from "../dom";
import { reading } from "../format";
import type { Run } from "../payload";
import { withUnit } from "./charts";

export class Extremes {
  readonly node = element("details", { class: "extremes", open: "" }, element("summary", {}, "Extremes of what is plotted"));
  private readonly body = element("tbody");

  constructor(private readonly runs: Run[], private readonly clock: Clock) {
    const heads = ["", "min", "at", "max", "at"].map((head) => element("th", { scope: "col", class: head ? "number" : "" }, head));
    const table = element("table", {}, element("thead", {}, element("tr", {}, ...heads)), this.body);
    this.node.append(element("div", { class: "scroll" }, table));
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
    const head = element("th", { scope: "row" }, this.runs.length > 1 ? `${name}, ${run.label}` : name);
    return [element("tr", {}, head, number(reading(least)), this.at(leastAt), number(reading(most)), this.at(mostAt))];
  }

  /** A time, which the page goes to when it is clicked. */
  private at(t: number): HTMLElement {
    const button = element("button", { type: "button", title: "show this moment" }, `${reading(t)} s`);
    button.addEventListener("click", () => this.clock.setTime(t));
    return element("td", { class: "number" }, button);
  }
}

function number(text: string): HTMLElement {
  return element("td", { class: "number" }, text);
}
