// One plot: heading with the values under the cursor, curves, and a marker at the current time.

import uPlot from "uplot";
import type { Clock } from "../clock";
import { element } from "../dom";
import { reading } from "../format";
import { rowAt } from "../motion";
import { curveColor, curveDash, onThemeChange, theme } from "../theme";
import type { Visibility } from "../visibility";
import type { Chart, Curve } from "./charts";
import { linearLabels, linearRange, logFloor, logLabels, logRange, logSplits } from "./scales";

const HEIGHT = 215;
const FONT = "11px system-ui, sans-serif";
/** Wide enough for the longest label, equal in all plots so that their time axes are in line. */
const LABEL_WIDTH = 66;
/** A press that moves less is a click, not the choice of a range; px. */
const CLICK = 3;

export function buildPlot(container: HTMLElement, chart: Chart, clock: Clock, visibility: Visibility, compared: boolean): void {
  const heading = new Heading(chart, compared);
  const drawing = element("div", { class: "drawing" });
  const figure = element("figure", { class: "plot" }, heading.node, drawing);
  container.append(figure);

  const marker = element("div", { class: "marker" });
  const hovered = (plot: uPlot): number | undefined => {
    const left = plot.cursor.left ?? -1;
    return left >= 0 ? plot.posToVal(left, "x") : undefined;
  };
  const refresh = (plot: uPlot): void => heading.show(hovered(plot) ?? clock.time);
  const mark = (plot: uPlot): void => {
    const left = plot.valToPos(clock.time, "x");
    marker.style.display = left >= 0 && left <= plot.over.clientWidth ? "" : "none";
    marker.style.transform = `translateX(${left}px)`;
  };
  const options = plotOptions(chart, drawing.clientWidth || 500);
  options.hooks = { setCursor: [refresh], setScale: [mark], setSize: [mark] };
  const plot = new uPlot(options, tableOf(chart), drawing);
  plot.over.append(marker);
  onClick(plot.over, (x) => clock.setTime(plot.posToVal(x, "x")));

  const showCurves = (): void => {
    chart.curves.forEach((curve, i) => {
      const shown = curve.shown && visibility.shows(curve.run);
      if (plot.series[i + 1].show !== shown) plot.setSeries(i + 1, { show: shown });
    });
    heading.refresh(visibility);
  };
  heading.onToggle = showCurves;
  visibility.onChange(showCurves);
  showCurves();
  clock.onTime(() => {
    mark(plot);
    refresh(plot);
  });
  heading.show(clock.time);
  mark(plot);
  new ResizeObserver(() => plot.setSize({ width: drawing.clientWidth, height: HEIGHT })).observe(drawing);
  onThemeChange(() => {
    plot.redraw(false);
    showCurves();
  });
}

/** Title and one entry per curve; entries are switches where the plot itself holds several curves of one run. */
class Heading {
  readonly node: HTMLElement;
  onToggle = (): void => {};
  private readonly entries: HTMLElement[];
  private readonly values: HTMLElement[];

  constructor(private readonly chart: Chart, private readonly compared: boolean) {
    const switches = !compared && chart.curves.length > 1;
    this.values = chart.curves.map(() => element("span", { class: "value" }));
    this.entries = chart.curves.map((curve, i) => {
      const swatch = element("span", { class: "swatch" });
      if (!switches) return element("span", { class: "entry", title: curve.label }, ...(compared ? [swatch] : []), this.values[i]);
      const button = element("button", { type: "button", class: "entry" }, swatch, curve.label, this.values[i]);
      button.addEventListener("click", () => {
        curve.shown = !curve.shown;
        this.onToggle();
      });
      return button;
    });
    this.node = element("figcaption", {}, element("h3", {}, chart.title), element("div", { class: "entries" }, ...this.entries));
  }

  show(t: number): void {
    this.chart.curves.forEach((curve, i) => (this.values[i].textContent = reading(valueAt(curve, t))));
  }

  refresh(visibility: Visibility): void {
    this.chart.curves.forEach((curve, i) => {
      const entry = this.entries[i];
      const shown = curve.shown && visibility.shows(curve.run);
      const swatch = entry.querySelector<HTMLElement>(".swatch");
      if (swatch) swatch.style.background = curveColor(curve.colour);
      if (entry instanceof HTMLButtonElement) entry.setAttribute("aria-pressed", String(shown));
      else entry.hidden = this.compared && !shown;
    });
  }
}

function valueAt(curve: Curve, t: number): number | undefined {
  const row = rowAt(curve.x, t);
  const next = Math.min(row + 1, curve.x.length - 1);
  return curve.y[curve.x[next] - t < t - curve.x[row] ? next : row];
}

/** All curves over one common time axis. */
function tableOf(chart: Chart): uPlot.AlignedData {
  const floor = chart.scale === "log" ? logFloor(chart.curves.flatMap((curve) => [...curve.y])) : undefined;
  const drawn = (value: number): number | null => {
    if (!Number.isFinite(value)) return null;
    return floor === undefined ? value : Math.max(value, floor);
  };
  const tables = chart.curves.map((curve) => [[...curve.x], Array.from(curve.y, drawn)] as uPlot.AlignedData);
  const same = chart.curves.every((curve) => curve.x === chart.curves[0].x);
  return same ? [tables[0][0], ...tables.map((table) => table[1])] as uPlot.AlignedData : uPlot.join(tables);
}

function plotOptions(chart: Chart, width: number): uPlot.Options {
  const log = chart.scale === "log";
  const paths = chart.scale === "steps" ? uPlot.paths.stepped?.({ align: -1 }) : undefined;
  const axis = { stroke: () => theme().soft, font: FONT, labelFont: FONT, grid: { stroke: () => theme().line, width: 1 }, ticks: { show: false } };
  return {
    width,
    height: HEIGHT,
    legend: { show: false },
    padding: [8, 12, 0, 0],
    cursor: { sync: { key: "holonom" }, dataIdx: nearestRow, y: false, points: { size: 7 } },
    scales: {
      x: { time: false },
      y: log ? { distr: 3, range: logRange } : { range: linearRange(chart.leastSpan, chart.scale === "steps") },
    },
    axes: [
      { ...axis, label: "t (s)", labelSize: 16, labelGap: 0, size: 26, values: linearLabels },
      log
        ? { ...axis, size: LABEL_WIDTH, splits: logSplits, values: logLabels, filter: (_, splits) => splits }
        : { ...axis, size: LABEL_WIDTH, space: 32, values: linearLabels, ...(chart.scale === "steps" ? { incrs: [1, 2, 5, 10, 20, 50, 100] } : {}) },
    ],
    series: [
      {},
      ...chart.curves.map((curve): uPlot.Series => {
        const dash = curveDash(curve.colour);
        return {
          label: curve.label,
          stroke: () => curveColor(curve.colour),
          width: 1.5,
          points: { show: false },
          ...(paths ? { paths } : {}),
          ...(dash ? { dash } : {}),
        };
      }),
    ],
  };
}

/** Runs with different steps leave gaps in the common table: the dot goes to the nearest row that the curve has. */
function nearestRow(plot: uPlot, series: number, row: number): number {
  const values = plot.data[series];
  for (let away = 0; away < values.length; away++) {
    if (values[row - away] !== undefined) return row - away;
    if (values[row + away] !== undefined) return row + away;
  }
  return row;
}

function onClick(over: HTMLElement, act: (x: number) => void): void {
  let pressed = NaN;
  over.addEventListener("mousedown", (event) => (pressed = event.clientX));
  over.addEventListener("mouseup", (event) => {
    if (Math.abs(event.clientX - pressed) < CLICK) act(event.clientX - over.getBoundingClientRect().left);
  });
}
