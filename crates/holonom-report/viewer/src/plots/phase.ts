// A plot of one column over another: the path of each run, with a dot at the current time.

import uPlot from "uplot";
import type { Clock } from "../clock";
import { element } from "../dom";
import { curveColor, curveDash, onThemeChange, theme } from "../theme";
import type { Visibility } from "../visibility";
import { withUnit, type Chart, type Curve } from "./charts";
import { Readout } from "./comparison";
import { FONT, HEIGHT, LABEL_WIDTH, onClick, UNIT_WIDTH } from "./plot";
import { straight } from "./path";
import { pictureButton } from "./picture";
import { linearAxis, linearTicks } from "./scales";
import { rowNear } from "./values";

export function buildPhasePlot(container: HTMLElement, chart: Chart, clock: Clock, visibility: Visibility): uPlot {
  const place = element("div", { class: "drawing" });
  const title = `${withUnit(chart.title, chart.unit)} over ${withUnit(chart.over!.column, chart.over!.unit)}`;
  const figure = element("figure", { class: "plot" }, element("figcaption", {}, element("h3", {}, title)), place);
  container.append(figure);
  const plot = new uPlot(phaseOptions(chart, place.clientWidth || 500), tableOf(chart), place);
  figure.append(pictureButton(plot, title, chart.curves));
  const dots = chart.curves.map(() => element("div", { class: "dot" }));
  const readout = new Readout(chart, visibility);
  plot.over.append(...dots, readout.node);

  const mark = (): void =>
    chart.curves.forEach((curve, i) => {
      const row = rowNear(curve, clock.time);
      const [left, top] = [plot.valToPos(curve.across![row], "x"), plot.valToPos(curve.y[row], "y")];
      const inside = left >= 0 && left <= plot.over.clientWidth && top >= 0 && top <= plot.over.clientHeight;
      dots[i].style.display = inside && visibility.shows(curve.run) ? "" : "none";
      dots[i].style.background = curveColor(curve.colour);
      dots[i].style.transform = `translate(${left}px, ${top}px)`;
    });
  for (const event of ["setScale", "setSize"] as const) (plot.hooks[event] ??= []).push(mark);
  clock.onTime(mark, place);
  onThemeChange(() => {
    plot.redraw(false);
    mark();
  }, place);
  visibility.onChange(() => {
    chart.curves.forEach((curve, i) => plot.setSeries(i + 1, { show: visibility.shows(curve.run) }));
    mark();
  }, place);
  new ResizeObserver(() => place.clientWidth > 0 && plot.setSize({ width: place.clientWidth, height: HEIGHT })).observe(place);

  const near = (left: number, top: number): { curve: Curve; t: number } | undefined => nearest(plot, chart, visibility, left, top);
  plot.over.addEventListener("pointermove", (event) => {
    const bounds = plot.over.getBoundingClientRect();
    const found = near(event.clientX - bounds.left, event.clientY - bounds.top);
    if (found) readout.show(found.t, event.clientX - bounds.left, bounds.width, found.curve);
  });
  plot.over.addEventListener("pointerleave", () => readout.hide());
  onClick(plot.over, (left, top) => {
    const found = near(left, top);
    if (found) clock.setTime(found.t);
  });
  mark();
  return plot;
}

/** The row whose place in the drawing is nearest. */
function nearest(plot: uPlot, chart: Chart, visibility: Visibility, left: number, top: number): { curve: Curve; t: number } | undefined {
  let [found, least]: [{ curve: Curve; t: number } | undefined, number] = [undefined, Infinity];
  for (const curve of chart.curves.filter((curve) => visibility.shows(curve.run))) {
    for (let row = 0; row < curve.x.length; row++) {
      const distance = Math.hypot(plot.valToPos(curve.across![row], "x") - left, plot.valToPos(curve.y[row], "y") - top);
      if (distance < least) [found, least] = [{ curve, t: curve.x[row] }, distance];
    }
  }
  return found;
}

function tableOf(chart: Chart): uPlot.AlignedData {
  const finite = (values: Float64Array): (number | null)[] => Array.from(values, (value) => (Number.isFinite(value) ? value : null));
  return [null, ...chart.curves.map((curve) => [finite(curve.across!), finite(curve.y)])] as unknown as uPlot.AlignedData;
}

function phaseOptions(chart: Chart, width: number): uPlot.Options {
  const axis = { stroke: () => theme().soft, font: FONT, labelFont: FONT, grid: { stroke: () => theme().line, width: 1 }, ticks: { show: false } };
  const range = (_: uPlot, min: number | null, max: number | null): uPlot.Range.MinMax =>
    linearAxis(Number.isFinite(min) && Number.isFinite(max) && min !== null && max !== null ? [min, max] : undefined, chart.leastSpan, false);
  return {
    mode: 2,
    width,
    height: HEIGHT,
    legend: { show: false },
    padding: [8, 12, 0, 0],
    cursor: { x: false, y: false, points: { show: false }, dataIdx: () => null as unknown as number },
    scales: { x: { time: false, range }, y: { range } },
    axes: [
      { ...axis, label: withUnit(chart.over!.column, chart.over!.unit), labelSize: 16, labelGap: 0, size: 26, ...linearTicks(50) },
      { ...axis, label: chart.unit || " ", labelSize: UNIT_WIDTH, labelGap: 0, size: LABEL_WIDTH, ...linearTicks(32) },
    ],
    series: [
      {},
      ...chart.curves.map((curve): uPlot.Series => ({
        label: curve.label,
        stroke: () => curveColor(curve.colour),
        width: 1.5,
        points: { show: false },
        facets: [{ scale: "x", auto: true }, { scale: "y", auto: true }],
        paths: straight,
        ...(curveDash(curve.colour) ? { dash: curveDash(curve.colour) } : {}),
      })),
    ],
  };
}
