// Which runs are shown, in the picture and in all plots alike, and the legend that switches them.

import { element } from "./dom";
import { curveColor, onThemeChange } from "./theme";

export class Visibility {
  private readonly hidden = new Set<number>();
  private readonly listeners: (() => void)[] = [];

  shows(run: number): boolean {
    return !this.hidden.has(run);
  }

  toggle(run: number): void {
    if (!this.hidden.delete(run)) this.hidden.add(run);
    for (const listener of this.listeners) listener();
  }

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }
}

/** One button per run; nothing for a single run. */
export function buildLegend(container: HTMLElement, labels: string[], visibility: Visibility): void {
  if (labels.length < 2) return;
  const buttons = labels.map((label, run) => {
    const button = element("button", { type: "button", "data-run": String(run) }, element("span", { class: "swatch" }), label);
    button.addEventListener("click", () => visibility.toggle(run));
    return button;
  });
  container.append(...buttons);
  const refresh = (): void => {
    buttons.forEach((button, run) => button.setAttribute("aria-pressed", String(visibility.shows(run))));
    colourSwatches();
  };
  visibility.onChange(refresh);
  onThemeChange(refresh);
  refresh();
}

/** The table at the top of the page names the runs too; its swatches get the same colours. */
function colourSwatches(): void {
  for (const swatch of document.querySelectorAll<HTMLElement>(".swatch")) {
    const owner = swatch.closest<HTMLElement>("[data-run]");
    if (owner) swatch.style.background = curveColor(Number(owner.dataset["run"]));
  }
}
