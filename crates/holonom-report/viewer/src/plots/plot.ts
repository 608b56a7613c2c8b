// One plot: heading, curves, and a marker at the current time.

import uPlot from "uplot";
import type { Clock } from "../clock";
import { element } from "../dom";
import { reading } from "../format";
import { curveColor, curveDash, onThemeChange, theme } from "../theme";
import type { Visibility } from "../visibility";
import { axisOf, departures, largestDrawn, type Departure, type Extent } from "./bounds";
import { withUnit, type Chart, type Curve } from "./charts";
import { ComparedHeading, Readout } from "./comparison";
import { Heading } from "./heading";
import { straight } from "./path";
import { pictureButton } from "./picture";
import { linearLabels, linearTicks, logFloor, logLabels, logSplits } from "./scales";

export const HEIGHT = 215;
export const FONT = "11px system-ui, sans-serif";
/** Wide enough for the longest label, equal in all plots so that their time axes are in line. */
export const LABEL_WIDTH = 58;
export const UNIT_WIDTH = 16;
/** A press that moves less is a click, not the choice of a range; px. */
const CLICK = 3;
/** How much is left of the curves beside the one that is pointed at in the legend. */
const FADED = 0.12;

/** A plot of one run, with the values of its curves in the heading. */
export function buildPlot(container: HTMLElement, chart: Chart, clock: Clock, visibility: Visibility): uPlot {
  const heading = new Heading(chart);
  const drawing = new Drawing(container, heading.node, chart, clock, visibility);
  const read = (): void => heading.show(drawing.time());
  drawing.on("setCursor", read);
  clock.onTime(read, heading.node);
  const refresh = (): void => {
    drawing.showCurves();
    heading.refresh();
  };
  heading.onToggle = refresh;
  onThemeChange(refresh, heading.node);
  refresh();
  read();
  drawing.showReadout(new Readout(chart, visibility));
  return drawing.plot;
}

/** A plot of several runs, with the values of their curves beside the pointer. */
export function buildComparedPlot(container: HTMLElement, chart: Chart, clock: Clock, visibility: Visibility): uPlot {
  const heading = new ComparedHeading(chart);
  const drawing = new Drawing(container, heading.node, chart, clock, visibility);
  const { plot } = drawing;
  const refresh = (): void => heading.refresh(drawing.showCurves());
  visibility.onChange(refresh, heading.node);
  refresh();

  drawing.showReadout(new Readout(chart, visibility));
  visibility.onHighlight(() => {
    const series = 1 + chart.curves.findIndex((curve) => curve.run === visibility.highlighted && visibility.shows(curve.run));
    plot.setSeries(series === 0 ? null : series, { focus: series > 0 });
  }, heading.node);
  return plot;
}

/** What a time axis spans of a single row, s; else it would be 100 s. */
const INSTANT = 1e-3;

/** The curves of a chart under a heading. */
class Drawing {
  readonly plot: uPlot;
  private readonly marker = element("div", { class: "marker" });
  /** A line for each moment that is marked, under the pointer wider than it looks. */
  private readonly moments: HTMLElement[];
  /** The last rows of curves that are cut. */
  private rows: Map<Curve, number>;

  constructor(
    container: HTMLElement,
    heading: HTMLElement,
    private readonly chart: Chart,
    private readonly clock: Clock,
    private readonly visibility: Visibility,
  ) {
    const place = element("div", { class: "drawing" });
    const figure = element("figure", { class: "plot" }, heading, place);
    container.append(figure);
    this.rows = lastRows(departures(chart, this.shown()));
    this.plot = new uPlot(plotOptions(chart, place.clientWidth || 500), tableOf(chart, this.rows), place);
    this.moments = clock.moments.map(({ t, name }) => element("div", { class: "event", title: `${name} at ${reading(t)} s` }));
    this.plot.over.append(...this.moments, this.marker);
    figure.append(pictureButton(this.plot, withUnit(chart.title, chart.unit), chart.curves));
    onClick(this.plot.over, (x) => clock.setTime(this.plot.posToVal(x, "x")));
    const mark = (): void => this.mark();
    this.on("setScale", mark);
    this.on("setSize", mark);
    clock.onTime(mark, place);
    onThemeChange(() => this.plot.redraw(false), place);
    // A drawing that is folded away has no width.
    new ResizeObserver(() => place.clientWidth > 0 && this.plot.setSize({ width: place.clientWidth, height: HEIGHT })).observe(place);
    mark();
  }

  on(event: "setCursor" | "setScale" | "setSize", listener: () => void): void {
    (this.plot.hooks[event] ??= []).push(listener);
  }

  /** Time and values beside the pointer. */
  showReadout(readout: Readout): void {
    const { over } = this.plot;
    over.append(readout.node);
    over.addEventListener("pointermove", (event) => {
      const left = event.clientX - over.getBoundingClientRect().left;
      readout.show(this.plot.posToVal(left, "x"), left, over.clientWidth);
    });
    over.addEventListener("pointerleave", () => readout.hide());
  }

  /** The time under the pointer, else that of the page. */
  time(): number {
    const left = this.plot.cursor.left ?? -1;
    return left >= 0 ? this.plot.posToVal(left, "x") : this.clock.time;
  }

  /** Shows and hides curves, and cuts those that leave the axis; these are handed back. */
  showCurves(): Departure[] {
    const shown = this.shown();
    const gone = departures(this.chart, shown);
    this.chart.curves.forEach((curve, i) => {
      const show = shown.includes(curve);
      if (this.plot.series[i + 1].show !== show) this.plot.setSeries(i + 1, { show });
    });
    this.cut(lastRows(gone));
    this.mark();
    return gone;
  }

  private shown(): Curve[] {
    return this.chart.curves.filter((curve) => curve.shown && this.visibility.shows(curve.run));
  }

  private cut(rows: Map<Curve, number>): void {
    if (rows.size === this.rows.size && [...rows].every(([curve, row]) => this.rows.get(curve) === row)) return;
    this.rows = rows;
    const { min, max } = this.plot.scales["x"];
    this.plot.setData(tableOf(this.chart, rows));
    // New data show all of the time axis again.
    if (typeof min === "number" && typeof max === "number") this.plot.setScale("x", { min, max });
  }

  private mark(): void {
    this.put(this.marker, this.clock.time, true);
    this.clock.moments.forEach(({ t, run }, i) => this.put(this.moments[i], t, this.visibility.shows(run)));
  }

  private put(line: HTMLElement, t: number, shows: boolean): void {
    const left = this.plot.valToPos(t, "x");
    line.style.display = shows && left >= 0 && left <= this.plot.over.clientWidth ? "" : "none";
    line.style.transform = `translateX(${left}px)`;
  }
}

function lastRows(gone: Departure[]): Map<Curve, number> {
  return new Map(gone.map(({ curve, row }) => [curve, row]));
}

/** All curves over one common time axis, cut after the rows given for some. */
function tableOf(chart: Chart, cutAfter: Map<Curve, number>): uPlot.AlignedData {
  const floor = chart.scale === "log" ? logFloor(chart.curves.flatMap((curve) => [...curve.y])) : -Infinity;
  const most = largestDrawn(chart);
  const tables = chart.curves.map((curve) => {
    const last = cutAfter.get(curve) ?? Infinity;
    const within = (value: number): number => Math.min(Math.max(value, floor, -most), most);
    const drawn = (value: number, row: number): number | null => (Number.isFinite(value) && row <= last ? within(value) : null);
    return [[...curve.x], Array.from(curve.y, drawn)] as uPlot.AlignedData;
  });
  const same = chart.curves.every((curve) => curve.x === chart.curves[0].x);
  return same ? [tables[0][0], ...tables.map((table) => table[1])] as uPlot.AlignedData : uPlot.join(tables);
}

function plotOptions(chart: Chart, width: number): uPlot.Options {
  const log = chart.scale === "log";
  const stepped = chart.scale === "steps" ? uPlot.paths.stepped?.({ align: -1 }) : undefined;
  const axis = { stroke: () => theme().soft, font: FONT, labelFont: FONT, grid: { stroke: () => theme().line, width: 1 }, ticks: { show: false } };
  // A unit that is left out has its room, too.
  const labelled = { size: LABEL_WIDTH, label: chart.unit || " ", labelSize: UNIT_WIDTH, labelGap: 0 };
  return {
    width,
    height: HEIGHT,
    legend: { show: false },
    // To the right there is half of the widest label of time, as 1.0·10⁻³.
    padding: [8, 24, 0, 0],
    focus: { alpha: FADED },
    cursor: { sync: { key: "holonom" }, dataIdx: nearestRow, y: false, points: { size: 7 } },
    scales: {
      x: { time: false, range: (plot, min, max) => (isInstant(plot) ? [plot.data[0][0], plot.data[0][0] + INSTANT] : [min, max]) },
      y: { distr: log ? 3 : 1, range: axisRange(chart) },
    },
    axes: [
      { ...axis, label: "t (s)", labelSize: 16, labelGap: 0, size: 26, ...linearTicks(50) },
      log
        ? { ...axis, ...labelled, splits: logSplits, values: logLabels, filter: (_, splits) => splits }
        : { ...axis, ...labelled, ...(chart.scale === "steps" ? { space: 32, values: linearLabels, incrs: [1, 2, 5, 10, 20, 50, 100] } : linearTicks(32)) },
    ],
    series: [
      {},
      ...chart.curves.map((curve): uPlot.Series => {
        const dash = curveDash(curve.colour);
        return {
          label: curve.label,
          stroke: () => curveColor(curve.colour),
          width: 1.5,
          // Of a single row there is no line.
          points: { show: isInstant },
          paths: stepped ?? straight,
          ...(dash ? { dash } : {}),
        };
      }),
    ],
  };
}

/** Whether there is one row, as of a run that stopped at its start. */
function isInstant(plot: uPlot): boolean {
  return plot.data[0].length === 1;
}

/** The axis for what the shown curves cover at present. */
function axisRange(chart: Chart): uPlot.Range.Function {
  return (plot) => {
    const extents = chart.curves.flatMap(({ sound }, i): Extent[] => {
      const { show, min, max } = plot.series[i + 1];
      return show && Number.isFinite(min) && Number.isFinite(max) ? [{ min: min!, max: max!, sound }] : [];
    });
    return axisOf(chart, extents);
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

export function onClick(over: HTMLElement, act: (x: number, y: number) => void): void {
  let pressed = NaN;
  over.addEventListener("mousedown", (event) => (pressed = event.clientX));
  over.addEventListener("mouseup", (event) => {
    if (Math.abs(event.clientX - pressed) < CLICK) act(event.clientX - over.getBoundingClientRect().left, event.clientY - over.getBoundingClientRect().top);
  });
}
