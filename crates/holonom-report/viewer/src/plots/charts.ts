// Which plots there are, and which curves are in them.

import type { Run } from "../payload";
import { energyMoved } from "./bounds";
import { envelope, mean } from "./smooth";

export interface Curve {
  /** Name of the column. */
  column: string;
  label: string;
  /** Index into the palette. */
  colour: number;
  /** Which run it belongs to. */
  run: number;
  /** The axis is scaled to curves of sound runs. */
  sound: boolean;
  /** Times, s. */
  x: Float64Array;
  y: Float64Array;
  /** What it is drawn over in place of time. */
  across?: Float64Array;
  shown: boolean;
}

export interface Chart {
  title: string;
  /** Of the y axis; empty for numbers without one. */
  unit: string;
  /** Column and unit of the x axis where that is not time. */
  over?: { column: string; unit: string };
  scale: "linear" | "log" | "steps";
  curves: Curve[];
  /** The y axis never spans less: rounding errors of a conserved quantity should not look like mountains. */
  leastSpan: number;
  /** Curves of runs that are not sound may leave the axis when they reach farther than this and than all sound ones. */
  allowed: number;
}

/** Column, name of the curve where one plot holds several. */
type Source = [column: string, label: string];

interface Plan {
  title: string;
  unit: string;
  scale: Chart["scale"];
  sources: Source[];
  /** Left out where every value is zero. */
  optional?: boolean;
  /** What is done to a column before it is drawn. */
  smooth?: (values: Float64Array) => Float64Array;
}

const VIOLATIONS: Plan[] = [
  { title: "Position violation ‖Φ‖", unit: "SI", scale: "log", sources: [["phi", ""]] },
  { title: "Velocity violation ‖Φ̇‖", unit: "SI/s", scale: "log", sources: [["phi_dot", ""]] },
  { title: "Acceleration violation ‖Φ̈‖", unit: "SI/s²", scale: "log", sources: [["phi_ddot", ""]] },
];

/** One run: what belongs together shares a plot. */
const SINGLE: Plan[] = [
  { title: "Energy", unit: "J", scale: "linear", sources: [["energy", "total"], ["kinetic", "kinetic"], ["potential", "potential"]] },
  { title: "Energy drift E − E(0) − W", unit: "J", scale: "linear", sources: [["drift", ""]] },
  ...VIOLATIONS,
  { title: "ΔE per step", unit: "J", scale: "linear", sources: [["dE_integrator", "integrator"], ["dE_projection", "projection"]] },
  { title: "ΔE summed", unit: "J", scale: "linear", sources: [["sum_dE_integrator", "integrator"], ["sum_dE_projection", "projection"]] },
  { title: "Iterations per step", unit: "", scale: "steps", sources: [["iterations", ""]] },
];

/** Several runs: one quantity per plot, one curve per run, without the noise in which they would drown each other. */
const COMPARED: Plan[] = [
  { title: "Total energy", unit: "J", scale: "linear", sources: [["energy", ""]] },
  { title: "Energy drift |E − E(0) − W|", unit: "J", scale: "log", sources: [["drift", ""]], smooth: envelope },
  ...VIOLATIONS.map((plan) => ({ ...plan, smooth: envelope })),
  { title: "Iterations per step, running mean", unit: "", scale: "steps", sources: [["iterations", ""]], smooth: mean },
  { title: "Integrator ΔEᵢ per step", unit: "J", scale: "linear", sources: [["dE_integrator", ""]] },
  { title: "Projection ΔEₚ per step", unit: "J", scale: "linear", sources: [["dE_projection", ""]], optional: true },
  { title: "Integrator ΔEᵢ summed", unit: "J", scale: "linear", sources: [["sum_dE_integrator", ""]] },
  { title: "Projection ΔEₚ summed", unit: "J", scale: "linear", sources: [["sum_dE_projection", ""]], optional: true },
];

/** A quantity with its unit, for headings. */
export function withUnit(name: string, unit: string): string {
  return unit === "" ? name : `${name} (${unit})`;
}

/** Only plots that some run has data for. */
export function charts(runs: Run[]): Chart[] {
  const compared = runs.length > 1;
  const moved = energyMoved(runs);
  return (compared ? COMPARED : SINGLE)
    .filter((plan) => !plan.optional || runs.some((run) => run.columns.get(plan.sources[0][0])?.some((value) => value !== 0)))
    .map((plan) => ({
      title: plan.title,
      unit: plan.unit,
      scale: plan.scale,
      curves: runs.flatMap((run, index) => plan.sources.flatMap((source, i) => curve(run, index, source, compared ? index : i, plan.smooth))),
      leastSpan: plan.sources[0][0] === "energy" ? 0.02 * moved : 0,
      allowed: compared && plan.scale === "linear" ? moved : Infinity,
    }))
    .filter((chart) => chart.curves.length > 0);
}

function curve(run: Run, index: number, [column, label]: Source, colour: number, smooth: Plan["smooth"]): Curve[] {
  const values = run.columns.get(column);
  if (!values) return [];
  const y = smooth ? smooth(values) : values;
  return [{ column, label: label || run.label, colour, run: index, sound: run.sound, x: run.times, y, shown: true }];
}
