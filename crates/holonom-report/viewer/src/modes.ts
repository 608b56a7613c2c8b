// Modes: the mechanism swings in the one that is chosen in the table, as `src/modes.rs` writes them.

import { Quaternion, Vector3 } from "three";
import { Clock } from "./clock";
import { element, place } from "./dom";
import { offer } from "./handle";
import { Motion } from "./motion";
import { bytesOf, seenFromOrigin, type Run, type Scene, type Vec3 } from "./payload";
import { Selection } from "./selection";
import { playButton } from "./transport";
import { boundingBox, diagonal } from "./view/frame";
import { buildStage } from "./view/stage";
import { Visibility } from "./visibility";

interface Shape {
  label: string;
  /** Name → base64 of real parts along the coordinates, then imaginary parts. */
  points: Record<string, string>;
  bodies: Record<string, string>;
}

interface Payload {
  origin: Vec3;
  scene: Scene;
  /** Name → pose at rest. */
  points: Record<string, number[]>;
  bodies: Record<string, number[]>;
  modes: Shape[];
}

/** One vibration on the screen, s. */
const PERIOD = 2;
/** What moves most moves by so much of the mechanism's size, or turns by so much, rad; a slider makes less or more of it. */
const WAY = 0.1;
const TURN = 0.35;
const SLIDER = { min: "0", max: "3", step: "0.01", value: "1" };

/** Shows the modes of the page; false where it has none. */
export function showModes(): boolean {
  const text = document.getElementById("holonom-modes")?.textContent;
  if (!text) return false;
  const payload = JSON.parse(text) as Payload;
  const rows = [...document.querySelectorAll<HTMLElement>(".modes tbody tr")].slice(0, payload.modes.length);
  const swing = new Swing(payload);
  const clock = new Clock(0, Number.MAX_VALUE);
  clock.speed = 1;
  const stage = element("div", { class: "stage" });
  const name = element("output", { class: "now" });
  const amplitude = element("input", { type: "range", "aria-label": "Amplitude", ...SLIDER });
  const { button, refresh } = playButton(() => clock.toggle(), " (space bar); arrow keys go through the modes");
  place("motion").append(stage, element("div", { class: "transport" }, button, name, element("label", { class: "speed" }, "amplitude", amplitude)));

  // What moves is brought there before it is drawn.
  clock.onTime((t) => swing.take((2 * Math.PI * t) / PERIOD, Number(amplitude.value)));
  clock.onPlaying(refresh);
  refresh(false);
  offer(swing.moving, clock, buildStage(stage, [swing.moving, swing.resting], clock, new Visibility(), new Selection(), { all: "both", arrows: "go through the modes" }));

  let chosen = 0;
  const choose = (k: number): void => {
    chosen = Math.min(Math.max(k, 0), rows.length - 1);
    rows.forEach((row, i) => row.setAttribute("aria-selected", String(i === chosen)));
    if (rows[chosen]) reveal(rows[chosen]);
    name.textContent = payload.modes[chosen]?.label ?? "";
    swing.choose(chosen);
    clock.setTime(clock.time);
  };
  rows.forEach((row, k) => row.addEventListener("click", () => choose(k)));
  amplitude.addEventListener("input", () => clock.setTime(clock.time));
  document.addEventListener("keydown", (event) => {
    const target = event.target instanceof Element ? event.target : document.body;
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey || event.shiftKey || target.closest("input, select")) return;
    if (event.key === "ArrowDown" || event.key === "ArrowRight") choose(chosen + 1);
    else if (event.key === "ArrowUp" || event.key === "ArrowLeft") choose(chosen - 1);
    else if (event.key === " " && !event.repeat && !target.closest("button, summary, a[href]")) clock.toggle();
    else return;
    event.preventDefault();
  });
  choose(0);
  // A quarter of a vibration on, where it is farthest.
  clock.setTime(PERIOD / 4);
  if (rows.length > 0 && !matchMedia("(prefers-reduced-motion: reduce)").matches) clock.play();
  return true;
}

/** Scrolls the table, and not the page, to where a row is seen below the headings. */
function reveal(row: HTMLElement): void {
  const box = row.closest(".modes");
  if (!box) return;
  const above = row.offsetTop - (box.querySelector("thead")?.offsetHeight ?? 0);
  const below = row.offsetTop + row.offsetHeight - box.clientHeight;
  box.scrollTop = Math.min(Math.max(box.scrollTop, below), above);
}

/** Real and imaginary parts of what moves one thing. */
type Part = Float32Array;

/** The mechanism in a mode, and at rest. */
class Swing {
  readonly moving: Motion;
  readonly resting: Motion;
  private readonly axes: number;
  private parts = new Map<string, Part>();
  /** From the numbers of the mode to what is shown. */
  private scale = 0;

  constructor(private readonly payload: Payload) {
    this.axes = payload.scene.axes.length;
    this.moving = this.motion("in the mode");
    this.resting = this.motion("at rest");
  }

  choose(mode: number): void {
    const shape = this.payload.modes[mode];
    this.parts = new Map();
    let [way, turn] = [0, 0];
    for (const [kind, of] of [["point", shape?.points ?? {}], ["body", shape?.bodies ?? {}]] as const) {
      for (const [name, text] of Object.entries(of)) {
        const part = new Float32Array(bytesOf(text));
        const half = part.length / 2;
        this.parts.set(`${kind} ${name}`, part);
        const size = (from: number, to: number): number => Math.hypot(...part.subarray(from, to), ...part.subarray(half + from, half + to));
        way = Math.max(way, size(0, this.axes));
        if (kind === "body") turn = Math.max(turn, size(this.axes, half));
      }
    }
    // Of a mechanism of one place the size is nothing, and it only turns.
    const room = diagonal(boundingBox([this.resting]));
    const scales = [(WAY * room) / way, TURN / turn].filter((scale) => Number.isFinite(scale) && scale > 0);
    this.scale = scales.length > 0 ? Math.min(...scales) : 0;
  }

  /** Brings everything to where it is at a phase, rad. */
  take(phase: number, amplitude: number): void {
    const [sine, cosine] = [Math.sin(phase), Math.cos(phase)].map((of) => of * amplitude * this.scale);
    // Velocities v e^(iφ) are those of places that are a quarter behind.
    const at = (part: Part | undefined, k: number): number => (part ? part[k] * sine + part[part.length / 2 + k] * cosine : 0);
    for (const [name, rest] of Object.entries(this.payload.points)) {
      const part = this.parts.get(`point ${name}`);
      this.moving.run.points.get(name)?.set(rest.map((x, k) => x + at(part, k)));
    }
    for (const [name, rest] of Object.entries(this.payload.bodies)) {
      const part = this.parts.get(`body ${name}`);
      const pose = rest.map((x, k) => (k < this.axes ? x + at(part, k) : x));
      if (this.axes === 2) pose[2] += at(part, 2);
      else {
        const turn = new Vector3(at(part, 3), at(part, 4), at(part, 5));
        const angle = turn.length();
        const [w, x, y, z] = rest.slice(3);
        const turned = new Quaternion().setFromAxisAngle(turn.normalize(), angle).multiply(new Quaternion(x, y, z, w));
        pose.splice(3, 4, turned.w, turned.x, turned.y, turned.z);
      }
      this.moving.run.bodies.get(name)?.set(pose);
    }
  }

  /** A run of one row, at rest. */
  private motion(label: string): Motion {
    const { origin, scene, points, bodies } = this.payload;
    const all = (of: Record<string, number[]>): Map<string, Float32Array> => new Map(Object.entries(of).map(([name, pose]) => [name, Float32Array.from(pose)]));
    const nothing = { columns: new Map(), events: [], channels: [], channelOf: new Map() };
    const run: Run = { label, sound: true, origin, scene: seenFromOrigin(scene, origin), points: all(points), bodies: all(bodies), times: new Float64Array(1), ...nothing };
    return new Motion(run, 0, WAY);
  }
}
