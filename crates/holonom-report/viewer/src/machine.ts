// What the machine does: efforts, forces and joint coordinates, and every other recorded column on demand.

import type { Clock } from "./clock";
import { element } from "./dom";
import type { Channel, Run } from "./payload";
import type { Chart } from "./plots/charts";
import { buildComparedPlot, buildPlot } from "./plots/plot";
import type { Visibility } from "./visibility";

/** Title, unit and ending of the channels that are shown from the start. */
const FIRST: [title: string, unit: string, ending: RegExp][] = [
  ["Efforts", "N·m", /\.effort$/],
  ["Efforts", "N", /\.effort$/],
  ["Tensions", "N", /\.force$/],
  ["Joint angles", "rad", /\.angle\d*$/],
  ["Joint displacements", "m", /\.displacement\d*$/],
];

/** Curves that a plot has room for. */
const MOST_CURVES = 8;

/** Plots of single channels where several runs are compared. */
const MOST_COMPARED = 4;

/** Plots of the machine, of `columns` where these are asked for, and a search over all columns. */
export function buildMachine(container: HTMLElement, runs: Run[], columns: string[], clock: Clock, visibility: Visibility): void {
  const channels = runs[0].channels;
  if (channels.length === 0) return;
  const plots = element("div", { class: "plots" });
  const compared = runs.length > 1;
  const build = compared ? buildComparedPlot : buildPlot;
  const asked = columns.flatMap((name) => channels.filter((channel) => channel.name === name));
  for (const channel of asked) build(plots, chartOf(titleOf(channel), [channel.name], runs), clock, visibility);
  const groups = asked.length > 0 ? [] : first(channels);
  if (compared) {
    const single = groups.flatMap(([, group]) => group).slice(0, MOST_COMPARED);
    for (const channel of single) build(plots, chartOf(titleOf(channel), [channel.name], runs), clock, visibility);
  } else {
    for (const [title, group] of groups) {
      const named = group.length > 1 ? title : titleOf(group[0]);
      build(plots, chartOf(named, group.map((channel) => channel.name), runs), clock, visibility);
    }
  }
  const add = (channel: Channel): void => {
    const place = element("div", { class: "asked" });
    const remove = element("button", { type: "button", class: "remove", title: "take this plot away" }, "×");
    remove.addEventListener("click", () => place.remove());
    plots.prepend(place);
    build(place, chartOf(titleOf(channel), [channel.name], runs), clock, visibility);
    place.append(remove, element("p", { class: "meaning" }, channel.meaning));
  };
  container.append(picker(channels, add), plots);
}

function titleOf(channel: Channel): string {
  return `${channel.name} (${channel.unit})`;
}

/** The groups of channels that are shown from the start; of a model without any of them the first coordinates. */
function first(channels: Channel[]): [string, Channel[]][] {
  const groups = FIRST.map(([title, unit, ending]): [string, Channel[]] => [
    `${title} (${unit})`,
    channels.filter((channel) => channel.unit === unit && ending.test(channel.name)).slice(0, MOST_CURVES),
  ]);
  const found = groups.filter(([, group]) => group.length > 0);
  if (found.length > 0) return found;
  const places = channels.filter((channel) => channel.unit === "m").slice(0, 3);
  return places.length > 0 ? [["Positions (m)", places]] : [];
}

/** A chart of some channels: a curve each, or one of each run. */
function chartOf(title: string, names: string[], runs: Run[]): Chart {
  const curves = runs.flatMap((run, index) =>
    names.flatMap((name, k) => {
      const channel = run.channels.find((channel) => channel.name === name);
      if (!channel) return [];
      const compared = runs.length > 1;
      const label = compared ? run.label : name.replace(/\.[a-z]+\d*$/, "");
      return [{ label, colour: compared ? index : k, run: index, sound: run.sound, x: run.times, y: channel.values, shown: true }];
    }),
  );
  return { title, scale: "linear", curves, leastSpan: 0, allowed: Infinity };
}

/** A field that finds a column by its name. */
function picker(channels: Channel[], add: (channel: Channel) => void): HTMLElement {
  const list = element("datalist", { id: "channels" });
  for (const channel of channels) list.append(element("option", { value: channel.name, label: `${channel.unit}: ${channel.meaning}` }));
  const field = element("input", { type: "search", list: "channels", placeholder: "a column, such as " + channels[0].name, "aria-label": "Plot a column" });
  const take = (): void => {
    const channel = channels.find((channel) => channel.name === field.value.trim());
    if (!channel) return;
    add(channel);
    field.value = "";
  };
  field.addEventListener("input", take);
  field.addEventListener("change", take);
  return element("p", { class: "picker" }, element("label", {}, `Plot one of ${channels.length} columns: `, field), list);
}
