// A piece of a run's curve, colour and dashes, for legends and tables.

import { curveColor, curveDash } from "./theme";

const NAMESPACE = "http://www.w3.org/2000/svg";
const [WIDTH, HEIGHT] = [26, 10];

export function curveSample(index: number): SVGSVGElement {
  const svg = document.createElementNS(NAMESPACE, "svg");
  const line = document.createElementNS(NAMESPACE, "line");
  set(svg, { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, width: WIDTH, height: HEIGHT, "aria-hidden": "true" });
  set(line, { x1: 1, x2: WIDTH - 1, y1: HEIGHT / 2, y2: HEIGHT / 2, stroke: curveColor(index), "stroke-width": 3.5 });
  const dash = curveDash(index);
  if (dash) set(line, { "stroke-dasharray": dash.join(" ") });
  svg.append(line);
  return svg;
}

/** Fills every place that waits for the sample of a run. */
export function fillSamples(): void {
  for (const swatch of document.querySelectorAll<HTMLElement>(".swatch[data-run]")) {
    swatch.replaceChildren(curveSample(Number(swatch.dataset["run"])));
  }
}

function set(node: Element, attributes: Record<string, string | number>): void {
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, String(value));
}
