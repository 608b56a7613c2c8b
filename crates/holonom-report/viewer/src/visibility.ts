// Which runs are shown in the plots, which one stands out, and the legend that switches both.

import { element } from "./dom";
import { Listeners } from "./listeners";
import { fillSamples } from "./sample";
import { onThemeChange } from "./theme";

export class Visibility {
  /** The run that the pointer is on in the legend. */
  highlighted: number | undefined;
  private readonly hidden = new Set<number>();
  private readonly listeners = new Listeners();
  private readonly highlightListeners = new Listeners();

  shows(run: number): boolean {
    return !this.hidden.has(run);
  }

  get showsAll(): boolean {
    return this.hidden.size === 0;
  }

  toggle(run: number): void {
    if (!this.hidden.delete(run)) this.hidden.add(run);
    this.changed();
  }

  showAll(): void {
    this.hidden.clear();
    this.changed();
  }

  /** Hides all runs but one. */
  showOnly(run: number, runs: number): void {
    for (let other = 0; other < runs; other++) this.hidden.add(other);
    this.hidden.delete(run);
    this.changed();
  }

  highlight(run: number | undefined): void {
    this.highlighted = run;
    this.highlightListeners.call();
  }

  onChange(listener: () => void, place?: Node): void {
    this.listeners.add(listener, place);
  }

  onHighlight(listener: () => void, place?: Node): void {
    this.highlightListeners.add(listener, place);
  }

  private changed(): void {
    this.listeners.call();
  }
}

const HINT = "click: show or hide · double click: only this one";

/** One button per run; nothing for a single run. */
export function buildLegend(container: HTMLElement, labels: string[], visibility: Visibility): void {
  if (labels.length < 2) return;
  const buttons = labels.map((label, run) => runButton(label, run, labels.length, visibility));
  const all = element("button", { type: "button", class: "all" }, "show all");
  all.addEventListener("click", () => visibility.showAll());
  container.append(...buttons, all);
  const refresh = (): void => {
    buttons.forEach((button, run) => button.setAttribute("aria-pressed", String(visibility.shows(run))));
    all.disabled = visibility.showsAll;
  };
  visibility.onChange(refresh);
  onThemeChange(fillSamples);
  refresh();
  fillSamples();
}

function runButton(label: string, run: number, runs: number, visibility: Visibility): HTMLButtonElement {
  const swatch = element("span", { class: "swatch", "data-run": String(run) });
  const button = element("button", { type: "button", title: HINT }, swatch, label);
  button.addEventListener("click", () => visibility.toggle(run));
  button.addEventListener("dblclick", () => visibility.showOnly(run, runs));
  button.addEventListener("pointerenter", () => visibility.highlight(run));
  button.addEventListener("pointerleave", () => visibility.highlight(undefined));
  return button;
}
