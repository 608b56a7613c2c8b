// Which of several mechanisms the picture shows.

import { element } from "../dom";
import type { Visibility } from "../visibility";

/** More mechanisms over each other are a tangle: then the picture begins with the first alone. */
const LEGIBLE = 3;

export class RunChoice {
  readonly node: HTMLElement;
  private readonly select = element("select", { "aria-label": "Run shown in the picture" });

  /** `all`: what all of them are called together. */
  constructor(labels: string[], private readonly visibility: Visibility, all: string) {
    labels.forEach((label, run) => this.select.append(element("option", { value: String(run) }, label)));
    this.select.append(element("option", { value: "" }, all));
    this.select.value = labels.length > LEGIBLE ? "0" : "";
    this.node = element("label", { class: "choice" }, "shown", this.select);
    this.node.hidden = labels.length < 2;
  }

  shows(run: number): boolean {
    return this.select.value === "" ? this.visibility.shows(run) : this.select.value === String(run);
  }

  onChange(listener: () => void): void {
    this.select.addEventListener("change", listener);
    this.visibility.onChange(listener);
  }
}
