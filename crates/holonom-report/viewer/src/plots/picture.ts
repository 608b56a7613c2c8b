// A plot as a picture of its own, with its title and its legend in it.

import type uPlot from "uplot";
import { element } from "../dom";
import { savePicture } from "../take";
import { curveColor, theme } from "../theme";
import type { Curve } from "./charts";

const FAMILY = "system-ui, sans-serif";
/** Height of a line of text, least distance of entries, and width of a sample, px. */
const [LINE, GAP, SAMPLE] = [20, 16, 18];
const MARGIN = 10;

/** A button that saves a plot; `curves`: of its series. */
export function pictureButton(plot: uPlot, title: string, curves: Curve[]): HTMLElement {
  const button = element("button", { type: "button", class: "take", title: `save ${title} as a picture` }, "PNG");
  button.addEventListener("click", () => savePicture(picture(plot, title, curves), title));
  return button;
}

function picture(plot: uPlot, title: string, curves: Curve[]): HTMLCanvasElement {
  const drawing = plot.ctx.canvas;
  const ratio = drawing.width / plot.width;
  const canvas = element("canvas");
  const pen = canvas.getContext("2d")!;
  const shown = curves.filter((_, i) => plot.series[i + 1].show);
  pen.font = `12px ${FAMILY}`;
  const entries = shown.length > 1 ? placed(shown, plot.width, (text) => pen.measureText(text).width) : [];
  const head = MARGIN + LINE + LINE * (1 + Math.max(-1, ...entries.map(({ line }) => line)));
  [canvas.width, canvas.height] = [drawing.width, Math.round((head + MARGIN) * ratio) + drawing.height];
  const { page, ink } = theme();
  pen.fillStyle = page;
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(drawing, 0, Math.round(head * ratio));
  pen.scale(ratio, ratio);
  pen.fillStyle = ink;
  pen.font = `600 13px ${FAMILY}`;
  pen.fillText(title, MARGIN, MARGIN + 0.7 * LINE);
  pen.font = `12px ${FAMILY}`;
  for (const { curve, left, line } of entries) {
    const level = MARGIN + LINE * (line + 1.7);
    pen.fillStyle = curveColor(curve.colour);
    pen.fillRect(left, level - 6, SAMPLE - 6, 4);
    pen.fillStyle = ink;
    pen.fillText(curve.label, left + SAMPLE, level);
  }
  return canvas;
}

/** Entries of the legend in lines that are not wider than the picture. */
function placed(curves: Curve[], width: number, measure: (text: string) => number): { curve: Curve; left: number; line: number }[] {
  let [left, line] = [MARGIN, 0];
  return curves.map((curve) => {
    const wide = SAMPLE + measure(curve.label);
    if (left > MARGIN && left + wide > width) [left, line] = [MARGIN, line + 1];
    const entry = { curve, left, line };
    left += wide + GAP;
    return entry;
  });
}
