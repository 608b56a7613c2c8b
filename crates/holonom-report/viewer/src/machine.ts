// What the machine does: measures, efforts, forces and joint coordinates, and every other recorded column on demand.

import type uPlot from "uplot";
import type { Clock } from "./clock";
import { element } from "./dom";
import type { Channel, Run } from "./payload";
import { energyMoved } from "./plots/bounds";
import type { Chart } from "./plots/charts";
import { Extremes } from "./plots/extremes";
import { buildPhasePlot } from "./plots/phase";
import { buildComparedPlot, buildPlot } from "./plots/plot";
import { ownersOf, type Selection } from "./selection";
import { save, table } from "./take";
import type { Visibility } from "./visibility";

/** Title, unit and ending of the channels that are shown from the start, behind the measures; none of them is that of a body. */
const FIRST: [title: string, unit: string, ending: RegExp][] = [
  ["Efforts", "N·m", /\.effort$/],
  ["Efforts", "N", /\.effort$/],
  ["Tensions", "N", /\.force$/],
  ["Joint angles", "rad", /\.angle\d*$/],
  ["Joint displacements", "m", /\.displacement\d*$/],
];

/** Curves that a plot has room for. */
const MOST_CURVES = 8;
/** Plots of measures; the others are found by the field. */
const MOST_MEASURES = 12;
/** Plots of single channels where several runs are compared. */
const MOST_COMPARED = 4;
/** Units of what is selected: what acts comes before motion. */
const ORDER = ["N", "N·m", "W", "rad", "m", "rad/s", "m/s", "rad/s²", "m/s²"];
/** Less is rounding of what is zero, and drawn as zero: of the largest channel with the same unit, and of angles; and of 1, or of the energy that moves where that is less. */
const ROUNDING = 1e-12;
const LEAST_SPAN = 1e-15;
/** Measures share a plot where none is so many times as large as another: the small one would be a flat line. */
const COMPARABLE = 20;

/** Channels in one plot. */
interface Group {
  title: string;
  channels: Channel[];
}

/** Plots of the machine, of `columns` where these are asked for, and a search over all columns. */
export function buildMachine(
  container: HTMLElement,
  runs: Run[],
  columns: string[],
  clock: Clock,
  visibility: Visibility,
  selection: Selection,
): void {
  if (runs.some((run) => run.channels.length > 0)) new Machine(container, runs, columns, clock, visibility, selection);
}

class Machine {
  private readonly channels: Channel[];
  private readonly plots = element("div", { class: "plots" });
  private readonly extremes: Extremes;
  /** Which item is selected in the picture, in words. */
  private readonly selected = element("p", { class: "selected", hidden: "" });
  /** What is plotted where. */
  private readonly shown = new Map<Element, { columns: string[]; plot: uPlot }>();

  constructor(
    container: HTMLElement,
    private readonly runs: Run[],
    columns: string[],
    private readonly clock: Clock,
    private readonly visibility: Visibility,
    private readonly selection: Selection,
  ) {
    this.channels = ofAny(runs);
    this.extremes = new Extremes(runs, clock);
    for (const group of this.first(columns)) {
      const place = element("div", { class: "shown" });
      this.plots.append(place);
      this.plot(place, group);
    }
    container.append(this.picker(), this.selected, this.plots, this.extremes.node);
    this.count();
    selection.onChange(() => this.select());
  }

  /** Plots that are shown from the start; a plot of several runs holds one channel. */
  private first(columns: string[]): Group[] {
    const asked = columns.flatMap((name) => this.channels.filter((channel) => channel.name === name));
    if (asked.length > 0) return asked.map((channel) => alone(channel));
    const groups = first(this.channels, bodiesAlone(this.runs));
    if (this.runs.length < 2) return groups;
    return apart(groups).slice(0, MOST_COMPARED);
  }

  /** Plots of what is selected in the picture come before all others. */
  private select(): void {
    for (const place of this.plots.querySelectorAll(".of-selected")) this.remove(place);
    const { item } = this.selection;
    this.selected.hidden = item === undefined;
    if (item) {
      const groups = ofOwners(this.channels, ownersOf(item, this.runs.map((run) => run.scene)));
      const clear = element("button", { type: "button", title: "select nothing (Escape)" }, "×");
      clear.addEventListener("click", () => this.selection.select(undefined));
      const words = groups.length > 0 ? "" : ", of which no column is recorded";
      this.selected.replaceChildren("Selected: ", element("b", {}, item.name), ` ${item.kind}${words} `, clear);
      for (const group of (this.runs.length > 1 ? apart(groups).slice(0, 2 * MOST_COMPARED) : groups).reverse()) {
        const place = element("div", { class: "shown of-selected" });
        this.plots.prepend(place);
        this.plot(place, group);
      }
    }
    this.count();
  }

  private remove(place: Element): void {
    place.remove();
    this.shown.get(place)?.plot.destroy();
    this.shown.delete(place);
  }

  private plot(place: HTMLElement, group: Group, over?: Channel): void {
    const build = over ? buildPhasePlot : this.runs.length > 1 ? buildComparedPlot : buildPlot;
    const columns = [...group.channels, ...(over ? [over] : [])].map((channel) => channel.name);
    this.shown.set(place, { columns, plot: build(place, chartOf(group, this.runs, over), this.clock, this.visibility) });
  }

  /** The table of extremes follows what is plotted. */
  private count(): void {
    this.extremes.show(this.plotted());
  }

  /** Columns, in the order of the page. */
  private plotted(): string[] {
    return [...new Set([...this.plots.children].flatMap((place) => this.shown.get(place)?.columns ?? []))];
  }

  /** A plot of its own in front of the others, whose x axis is chosen. */
  private ask(channel: Channel): void {
    const place = element("div", { class: "asked" });
    const remove = element("button", { type: "button", class: "remove", title: "take this plot away" }, "×");
    remove.addEventListener("click", () => {
      this.remove(place);
      this.count();
    });
    const field = element("input", { type: "search", list: "channels", placeholder: "t", "aria-label": "Column of the x axis" });
    const foot = element("p", { class: "meaning" }, element("label", {}, "over ", field), ` ${channel.meaning}`);
    const draw = (over?: Channel): void => {
      this.shown.get(place)?.plot.destroy();
      place.querySelector(".plot")?.remove();
      this.plot(place, alone(channel), over);
      place.append(remove, foot);
      this.count();
    };
    onColumn(field, this.channels, draw);
    field.addEventListener("input", () => ["", "t"].includes(field.value.trim()) && draw());
    this.plots.prepend(place);
    draw();
  }

  /** A field that finds a column by its name. */
  private picker(): HTMLElement {
    const list = element("datalist", { id: "channels" });
    for (const { name, unit, meaning } of this.channels) list.append(element("option", { value: name, label: `${unit}: ${meaning}` }));
    const placeholder = `a column, such as ${this.channels[0].name}`;
    const field = element("input", { type: "search", list: "channels", placeholder, "aria-label": "Plot a column" });
    onColumn(field, this.channels, (channel) => {
      this.ask(channel);
      field.value = "";
    });
    const take = element("button", { type: "button", class: "take", title: "save the columns that are plotted" }, "CSV of what is plotted");
    take.addEventListener("click", () => save(table(this.runs, this.plotted()), "", "csv"));
    return element("p", { class: "picker" }, element("label", {}, `Plot one of ${this.channels.length} columns: `, field), list, take);
  }
}

/** The first column whose name begins with some words, or has them in it. */
function matching(channels: Channel[], words: string): Channel | undefined {
  const part = words.toLowerCase();
  const of = (fits: (name: string) => boolean): Channel | undefined => channels.find(({ name }) => fits(name.toLowerCase()));
  return of((name) => name === part) ?? of((name) => name.startsWith(part)) ?? of((name) => name.includes(part));
}

/** A column is taken as soon as its name is whole, and by the Enter key from a part of it. */
function onColumn(field: HTMLInputElement, channels: Channel[], take: (channel: Channel) => void): void {
  let last = "";
  const look = (): void => {
    const name = field.value.trim();
    const channel = channels.find((channel) => channel.name === name);
    // Both events of one choice count once.
    if (channel && name !== last) take(channel);
    last = field.value.trim();
  };
  field.addEventListener("input", look);
  field.addEventListener("change", look);
  // When the key goes up a choice from the list has been taken already.
  field.addEventListener("keyup", ({ key }) => {
    const words = field.value.trim();
    const channel = key === "Enter" && !["", "t", last].includes(words) ? matching(channels, words) : undefined;
    if (!channel) return;
    field.value = channel.name;
    look();
  });
}

function alone(channel: Channel): Group {
  return { title: channel.name, channels: [channel] };
}

/** The channels of all runs, each once: what was measured has few of them. */
function ofAny(runs: Run[]): Channel[] {
  const known = new Map<string, Channel>();
  for (const channel of runs.flatMap((run) => run.channels)) if (!known.has(channel.name)) known.set(channel.name, channel);
  return [...known.values()];
}

/** As many of the channels as a plot has room for; the title says where these are not all. */
function fitting(title: string, channels: Channel[]): Group {
  const shown = channels.slice(0, MOST_CURVES);
  return { title: shown.length < channels.length ? `${title}, ${shown.length} of ${channels.length}` : title, channels: shown };
}

/** Names of bodies that are no names of joints: in a plane bodies have an `angle`, too. */
function bodiesAlone(runs: Run[]): Set<string> {
  const joints = new Set(runs.flatMap(({ scene }) => scene.joints.map(({ name }) => name)));
  return new Set(runs.flatMap(({ scene }) => scene.bodies.map(({ name }) => name)).filter((name) => !joints.has(name)));
}

function apart(groups: Group[]): Group[] {
  return groups.flatMap(({ channels }) => channels.map((channel) => alone(channel)));
}

/** The channels that are called NAME.SOMETHING or NAME after one of the owners, by unit. */
function ofOwners(channels: Channel[], owners: string[]): Group[] {
  const isOf = ({ name }: Channel, owner: string): boolean => name === owner || (name.startsWith(`${owner}.`) && !name.slice(owner.length + 1).includes("."));
  const direct = channels.filter((channel) => owners.some((owner) => isOf(channel, owner)));
  // A line that keeps many points straight has only columns of these, NAME.POINT.SOMETHING.
  const own = direct.length > 0 ? direct : channels.filter(({ name }) => owners.some((owner) => name.startsWith(`${owner}.`)));
  const rank = (unit: string): number => (ORDER.indexOf(unit) + 1 || ORDER.length + 1);
  const units = [...new Set(own.map(({ unit }) => unit))].sort((a, b) => rank(a) - rank(b));
  return units.map((unit) => {
    const group = own.filter((channel) => channel.unit === unit);
    return group.length > 1 ? fitting(owners[0], group) : alone(group[0]);
  });
}

/** The groups of channels that are shown from the start; of a model without any of them the first coordinates, or how it turns where these stay. */
function first(channels: Channel[], bodies: Set<string>): Group[] {
  const others = FIRST.map(([title, unit, ending]): Group => {
    const fits = ({ name }: Channel): boolean => ending.test(name) && !bodies.has(name.replace(ending, ""));
    return fitting(title, channels.filter((channel) => !channel.is_measure && channel.unit === unit && fits(channel)));
  });
  const found = [...measures(channels), ...others].filter((group) => group.channels.length > 0);
  if (found.length > 0) return found.map((group) => (group.channels.length > 1 ? group : alone(group.channels[0])));
  const [places, rates] = ["m", "rad/s"].map((unit) => channels.filter((channel) => channel.unit === unit).slice(0, 3));
  const moves = ({ extremes }: Channel): boolean => extremes !== null && extremes[0] !== extremes[2];
  if (!places.some(moves) && rates.some(moves)) return [{ title: "Angular velocities", channels: rates }];
  return places.length > 0 ? [{ title: "Positions", channels: places }] : [];
}

/** The largest magnitude of a channel. */
function size({ extremes }: Channel): number {
  return Math.max(Math.abs(extremes?.[0] ?? 0), Math.abs(extremes?.[2] ?? 0));
}

/** What a curve of a unit spans at least where it is no rounding. */
function leastSpan(runs: Run[], unit: string): number {
  const alike = runs.flatMap((run) => [...run.channelOf.values()].filter((channel) => channel.unit === unit));
  const largest = alike.map(size).filter(Number.isFinite).reduce((most, one) => Math.max(most, one), unit === "rad" ? 1 : 0);
  return Math.max(LEAST_SPAN * Math.min(energyMoved(runs) || 1, 1), ROUNDING * largest);
}

/** Measures of one unit and of like size share a plot. */
function measures(channels: Channel[]): Group[] {
  const groups: Group[] = [];
  for (const channel of channels.filter((channel) => channel.is_measure)) {
    const fits = (other: Channel): boolean => {
      const [small, large] = [size(channel), size(other)].sort((a, b) => a - b);
      return other.unit === channel.unit && large <= COMPARABLE * small;
    };
    const group = groups.find((group) => group.channels.length < MOST_CURVES && group.channels.every(fits));
    if (group) group.channels.push(channel);
    else groups.push({ title: "Measures", channels: [channel] });
  }
  return groups.slice(0, MOST_MEASURES);
}

/** A chart of some channels: a curve each, or one of each run; over time, or over another channel. */
function chartOf({ title, channels }: Group, runs: Run[], over: Channel | undefined): Chart {
  const compared = runs.length > 1;
  const shortened = channels.map(({ name }) => name.replace(/\.[a-z]+\d*$/, ""));
  const ambiguous = new Set(shortened).size < shortened.length;
  const curves = runs.flatMap((run, index) =>
    channels.flatMap(({ name }, k) => {
      const find = (name: string): Float64Array | undefined => run.channelOf.get(name)?.values;
      const [y, across] = [find(name), over && find(over.name)];
      if (!y || (over && !across)) return [];
      const label = compared ? run.label : ambiguous ? name : shortened[k];
      const curve = { column: name, label, colour: compared ? index : k, run: index, sound: run.sound, x: run.times, y, shown: true };
      return [across ? { ...curve, across } : curve];
    }),
  );
  const unit = channels[0].unit === "1" ? "" : channels[0].unit;
  const chart: Chart = { title, unit, scale: "linear", curves, leastSpan: leastSpan(runs, channels[0].unit), allowed: Infinity };
  return over ? { ...chart, over: { column: over.name, unit: over.unit === "1" ? "" : over.unit } } : chart;
}
