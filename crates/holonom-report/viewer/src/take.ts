// What can be taken away from the page: numbers as CSV, drawings as PNG. Files are made here, without a network.

import { element } from "./dom";
import { shortest } from "./format";
import type { Run } from "./payload";

/** Keeps the address of a file until the browser has begun to save it, ms. */
const PATIENCE = 60_000;

/** Hands a file to the browser, called after the page and a name. */
export function save(content: Blob, name: string, ending: string): void {
  const address = URL.createObjectURL(content);
  const file = `${document.title} ${name}`.replace(/[^\p{L}\p{N}._-]+/gu, "-").replace(/^-|-$/g, "");
  element("a", { href: address, download: `${file}.${ending}` }).click();
  setTimeout(() => URL.revokeObjectURL(address), PATIENCE);
}

export function savePicture(canvas: HTMLCanvasElement, name: string): void {
  canvas.toBlob((content) => content && save(content, name, "png"), "image/png");
}

/** Time and columns as `trajectory.csv` has them; of several runs below each other, with their names in front. */
export function table(runs: Run[], columns: string[]): Blob {
  const compared = runs.length > 1;
  const lines = [[...(compared ? ["run"] : []), "t", ...columns].map(quoted).join()];
  for (const { label, times, channelOf } of runs) {
    const values = columns.map((column) => channelOf.get(column)?.values);
    times.forEach((t, row) => {
      const numbers = [t, ...values.map((column) => column?.[row])].map((value) => (value === undefined ? "" : shortest(value)));
      lines.push([...(compared ? [quoted(label)] : []), ...numbers].join());
    });
  }
  return new Blob([lines.join("\n"), "\n"], { type: "text/csv" });
}

function quoted(text: string): string {
  return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}
