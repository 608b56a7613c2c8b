// Entry: reads the numbers in the page and fills the places that `src/page.rs` left.

import "uplot/dist/uPlot.min.css";
import "./licences";
import "./viewer.css";
import { Clock } from "./clock";
import { element, place } from "./dom";
import { offer } from "./handle";
import { listenToKeys } from "./keyboard";
import { buildMachine } from "./machine";
import { showModes } from "./modes";
import { Motion } from "./motion";
import { readPayload } from "./payload";
import { charts } from "./plots/charts";
import { buildComparedPlot, buildPlot } from "./plots/plot";
import { WINDOWS } from "./plots/smooth";
import { Selection } from "./selection";
import { buildTransport } from "./transport";
import { buildStage, type OnScreen } from "./view/stage";
import { buildLegend, Visibility } from "./visibility";

const HOW_TO_READ = `Axes fit the runs that completed with their energy in bounds; a run that leaves one is named above it and drawn up \
to there. Drift and violations are drawn as the largest within 1/${WINDOWS} of a run's rows, iterations as the mean there, everything else row \
by row. On a logarithmic axis zeros lie at the lower end. Rest the pointer on a run in the legend to see it alone; drag across a plot to zoom, \
double click to go back.`;

function main(): void {
  const payload = readPayload();
  const motions = payload.runs.map((run) => new Motion(run));
  const start = Math.min(...motions.map((motion) => motion.run.times[0] ?? 0));
  const several = motions.length > 1;
  const moments = motions.flatMap(({ run: { label, events } }, run) => events.map(([name, t]) => ({ t, run, name: several ? `${name} of ${label}` : name })));
  const clock = new Clock(start, Math.max(start, ...motions.map((motion) => motion.end)), moments);
  const onScreen = motions.length > 0 ? build(motions, payload.columns, clock, new Visibility()) : () => undefined;
  offer(motions[0], clock, onScreen);
}

function build(motions: Motion[], columns: string[], clock: Clock, visibility: Visibility): OnScreen {
  const runs = motions.map((motion) => motion.run);
  buildLegend(place("legend"), runs.map((run) => run.label), visibility);

  const stage = element("div", { class: "stage" });
  place("motion").append(stage, buildTransport(clock));
  const selection = new Selection();
  const onScreen = buildStage(stage, motions, clock, visibility, selection);

  listenToKeys(clock, runs[0].times);
  buildMachine(place("machine"), runs, columns, clock, visibility, selection);

  const plots = element("div", { class: "plots" });
  place("plots").append(plots);
  const build = runs.length > 1 ? buildComparedPlot : buildPlot;
  for (const chart of charts(runs)) build(plots, chart, clock, visibility);
  if (runs.length > 1) place("plots").append(element("p", { class: "note" }, HOW_TO_READ));
  return onScreen;
}

if (!showModes()) main();
