// Bodies can be made transparent or hidden, to see what lies behind or inside.

import { element } from "../dom";
import type { Selection } from "../selection";

export type Look = "shown" | "transparent" | "hidden";

const LOOKS: Look[] = ["shown", "transparent", "hidden"];

/** A list of bodies that folds out, with a switch for each and one for all; nothing where there are none. */
export function buildLooks(bodies: string[], selection: Selection, change: (body: string, look: Look) => void): HTMLElement | undefined {
  if (bodies.length === 0) return undefined;
  const rows = bodies.map((body) => {
    const toggle = new Toggle(`How ${body} is drawn`, (look) => change(body, look));
    const name = element("button", { type: "button", class: "select" }, body);
    name.addEventListener("click", () => selection.select({ sort: "body", kind: "body", name: body }));
    return { toggle, row: element("li", {}, name, toggle.button) };
  });
  const all = new Toggle("How all bodies are drawn", (look) => rows.forEach(({ toggle }) => toggle.set(look)));
  const first = bodies.length > 1 ? [element("li", {}, "all", all.button)] : [];
  return element("details", { class: "looks" }, element("summary", {}, "bodies"), element("ul", {}, ...first, ...rows.map(({ row }) => row)));
}

/** A button that goes from one look to the next. */
class Toggle {
  readonly button: HTMLButtonElement;
  private look: Look = "shown";

  constructor(label: string, private readonly act: (look: Look) => void) {
    this.button = element("button", { type: "button", title: label, "data-look": this.look }, this.look);
    this.button.addEventListener("click", () => this.set(LOOKS[(LOOKS.indexOf(this.look) + 1) % LOOKS.length]));
  }

  set(look: Look): void {
    this.look = look;
    this.button.textContent = look;
    this.button.dataset["look"] = look;
    this.act(look);
  }
}
