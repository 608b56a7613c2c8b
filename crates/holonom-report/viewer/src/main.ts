// Entry: reads the numbers in the page and fills the places that `src/page.rs` left.

import "uplot/dist/uPlot.min.css";
import "./licences";
import "./viewer.css";
import { Clock } from "./clock";
import { element, place } from "./dom";
import { listenToKeys } from "./keyboard";
import { buildMachine } from "./machine";
import { Motion } from "./motion";
import { readPayload, type Vec3 } from "./payload";
import { charts } from "./plots/charts";
import { buildComparedPlot, buildPlot } from "./plots/plot";
import { WINDOWS } from "./plots/smooth";
import { Selection } from "./selection";
import { buildTransport } from "./transport";
import { buildStage } from "./view/stage";
import { buildLegend, Visibility } from "./visibility";

/** What a page offers to scripts and tests. */
interface Handle {
  ready: boolean;
  time(): number;
  setTime(t: number): void;
  /** World places of the points of the first run at the current time, m. */
  pointsAt(): Record<string, Vec3>;
  /** The same of the centres of mass of its bodies. */
  bodiesAt(): Record<string, Vec3>;
  /** Where a place in the world is seen in the window, px. */
  onScreen(place: Vec3): [number, number] | undefined;
}

const HOW_TO_READ = `Axes fit the runs that completed with their energy in bounds; a run that leaves one is named above it and drawn up \
to there. Drift and violations are drawn as the largest within 1/${WINDOWS} of a run's rows, iterations as the mean there, everything else row \
by row. On a logarithmic axis zeros lie at the lower end. Rest the pointer on a run in the legend to see it alone; drag across a plot to zoom, \
double click to go back.`;

declare global {
  interface Window {
    holonom: Handle;
  }
}

function main(): void {
  const payload = readPayload();
  const origin = payload.runs[0]?.origin ?? [0, 0, 0];
  const world = (place: Vec3 | undefined): Vec3 | undefined => place && (place.map((x, i) => x + origin[i]) as Vec3);
  const motions = payload.runs.map((run) => new Motion(run));
  const start = Math.min(...motions.map((motion) => motion.run.times[0] ?? 0));
  const several = motions.length > 1;
  const moments = motions.flatMap(({ run: { label, events } }, run) => events.map(([name, t]) => ({ t, run, name: several ? `${name} of ${label}` : name })));
  const clock = new Clock(start, Math.max(start, ...motions.map((motion) => motion.end)), moments);
  const visibility = new Visibility();
  window.holonom = {
    ready: false,
    time: () => clock.time,
    setTime: (t) => clock.setTime(t),
    pointsAt: () => placesOf(motions[0]?.run.scene.points, (name) => world(motions[0]?.at(name, clock.time))),
    bodiesAt: () => placesOf(motions[0]?.run.scene.bodies, (name) => world(motions[0]?.poseAt(name, clock.time)?.place.toArray())),
    onScreen: () => undefined,
  };
  if (motions.length > 0) build(motions, payload.columns, clock, visibility);
  window.holonom.ready = true;
}

function build(motions: Motion[], columns: string[], clock: Clock, visibility: Visibility): void {
  const runs = motions.map((motion) => motion.run);
  buildLegend(place("legend"), runs.map((run) => run.label), visibility);

  const stage = element("div", { class: "stage" });
  place("motion").append(stage, buildTransport(clock));
  const selection = new Selection();
  const onScreen = buildStage(stage, motions, clock, visibility, selection);
  const { origin } = runs[0];
  window.holonom.onScreen = (place) => onScreen(place.map((x, i) => x - origin[i]) as Vec3);

  listenToKeys(clock, runs[0].times);
  buildMachine(place("machine"), runs, columns, clock, visibility, selection);

  const plots = element("div", { class: "plots" });
  place("plots").append(plots);
  const build = runs.length > 1 ? buildComparedPlot : buildPlot;
  for (const chart of charts(runs)) build(plots, chart, clock, visibility);
  if (runs.length > 1) place("plots").append(element("p", { class: "note" }, HOW_TO_READ));
}

function placesOf(named: { name: string }[] | undefined, at: (name: string) => Vec3 | undefined): Record<string, Vec3> {
  const places = named?.flatMap(({ name }) => {
    const place = at(name);
    return place ? [[name, place] as const] : [];
  });
  return Object.fromEntries(places ?? []);
}

main();
