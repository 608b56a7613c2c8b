// Which plots there are, and which curves are in them.

import type { Run } from "../payload";

export interface Curve {
  label: string;
  /** Index into the palette. */
  colour: number;
  /** Which run it belongs to. */
  run: number;
  x: Float64Array;
  y: Float64Array;
  shown: boolean;
}

export interface Chart {
  title: string;
  scale: "linear" | "log" | "steps";
  curves: Curve[];
  /** The y axis never spans less: rounding errors of a conserved quantity should not look like mountains. */
  leastSpan: number;
}

/** Column, name of the curve where one plot holds several. */
type Source = [column: string, label: string];

interface Plan {
  title: string;
  scale: Chart["scale"];
  sources: Source[];
}

const DRIFT: Plan[] = [{ title: "Energy drift E − E(0) − W (J)", scale: "linear", sources: [["drift", ""]] }];

const VIOLATIONS: Plan[] = [
  { title: "Position violation ‖Φ‖ (SI)", scale: "log", sources: [["phi", ""]] },
  { title: "Velocity violation ‖Φ̇‖ (SI/s)", scale: "log", sources: [["phi_dot", ""]] },
  { title: "Acceleration violation ‖Φ̈‖ (SI/s²)", scale: "log", sources: [["phi_ddot", ""]] },
];

const ITERATIONS: Plan[] = [{ title: "Iterations per step", scale: "steps", sources: [["iterations", ""]] }];

/** One run: what belongs together shares a plot. */
const SINGLE: Plan[] = [
  { title: "Energy (J)", scale: "linear", sources: [["energy", "total"], ["kinetic", "kinetic"], ["potential", "potential"]] },
  ...DRIFT,
  ...VIOLATIONS,
  { title: "ΔE per step (J)", scale: "linear", sources: [["dE_integrator", "integrator"], ["dE_projection", "projection"]] },
  { title: "ΔE summed (J)", scale: "linear", sources: [["sum_dE_integrator", "integrator"], ["sum_dE_projection", "projection"]] },
  ...ITERATIONS,
];

/** Several runs: one quantity per plot, one curve per run. */
const COMPARED: Plan[] = [
  { title: "Total energy (J)", scale: "linear", sources: [["energy", ""]] },
  ...DRIFT,
  ...VIOLATIONS,
  ...ITERATIONS,
  { title: "Integrator ΔEᵢ per step (J)", scale: "linear", sources: [["dE_integrator", ""]] },
  { title: "Projection ΔEₚ per step (J)", scale: "linear", sources: [["dE_projection", ""]] },
  { title: "Integrator ΔEᵢ summed (J)", scale: "linear", sources: [["sum_dE_integrator", ""]] },
  { title: "Projection ΔEₚ summed (J)", scale: "linear", sources: [["sum_dE_projection", ""]] },
];

/** Only plots that some run has data for. */
export function charts(runs: Run[]): Chart[] {
  const compared = runs.length > 1;
  return (compared ? COMPARED : SINGLE)
    .map(({ title, scale, sources }) => ({
      title,
      scale,
      curves: runs.flatMap((run, index) => sources.flatMap((source, i) => curve(run, index, source, compared ? index : i))),
      leastSpan: sources[0][0] === "energy" ? 0.02 * energyScale(runs) : 0,
    }))
    .filter((chart) => chart.curves.length > 0);
}

function curve(run: Run, index: number, [column, label]: Source, colour: number): Curve[] {
  const y = run.columns.get(column);
  return y ? [{ label: label || run.label, colour, run: index, x: run.times, y, shown: true }] : [];
}

/** How much energy goes back and forth in the mechanism, J. */
function energyScale(runs: Run[]): number {
  const spans = runs.map((run) => {
    const kinetic = (run.columns.get("kinetic") ?? new Float64Array()).filter(Number.isFinite);
    return kinetic.reduce((most, e) => Math.max(most, e), 0);
  });
  return Math.max(0, ...spans.filter(Number.isFinite));
}
