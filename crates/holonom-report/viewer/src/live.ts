// A simulation that goes on while it is looked at: a widget of a notebook, whose kernel takes the steps and sends frames.

import { Clock } from "./clock";
import { element } from "./dom";
import { Film, type Layout } from "./film";
import { Motion } from "./motion";
import { Selection } from "./selection";
import { playButton } from "./transport";
import { buildStage } from "./view/stage";
import { Visibility } from "./visibility";
import ownStyle from "./live.css";
import viewerStyle from "./viewer.css";

/** What anywidget shares with the kernel. */
interface Model {
  get(name: string): unknown;
  set(name: string, value: unknown): void;
  save_changes(): void;
  on(event: string, act: () => void): void;
  off(event: string, act: () => void): void;
}

interface Input {
  name: string;
  unit: string;
  meaning: string;
  /** Ends of its slider. */
  low: number;
  high: number;
}

/** Positions of a slider. */
const STEPS = 1000;
/** How far back trails go, s of the simulation at its own speed. */
const TRAIL = 1.5;
/** A first frame does not say where the others will be: room around it, over its size. */
const ROOM = 0.4;
const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10];

function render({ model, el }: { model: Model; el: HTMLElement }): () => void {
  // Neither style sheet reaches the other: that of the notebook, and that of the viewer.
  const root = el.attachShadow({ mode: "open" });
  const page = element("div", { class: "live" });
  root.append(element("style", {}, viewerStyle, model.get("_style") as string, ownStyle), page);

  const layout = JSON.parse(model.get("_layout") as string) as Layout;
  const film = new Film(layout, model.get("_frame") as DataView);
  const clock = new Clock(film.run.times[0], Infinity);
  const stage = element("div", { class: "stage" });
  const listening: [event: string, act: () => void][] = [];
  const listen = (name: string, act: () => void): void => {
    const event = `change:${name}`;
    listening.push([event, act]);
    model.on(event, act);
  };
  page.append(stage, transport(model, clock, listen), inputs(model, listen));
  buildStage(stage, [new Motion(film.run, TRAIL * (model.get("speed") as number), ROOM)], clock, new Visibility(), new Selection());
  listen("_frame", () => {
    film.take(model.get("_frame") as DataView);
    clock.setTime(film.run.times.at(-1) ?? 0);
  });
  return () => {
    for (const [event, act] of listening) model.off(event, act);
    // A browser has few of these, and a cell is run again and again.
    stage.querySelector("canvas")?.getContext("webgl2")?.getExtension("WEBGL_lose_context")?.loseContext();
  };
}

type Listen = (name: string, act: () => void) => void;

function send(model: Model, name: string, value: unknown): void {
  model.set(name, value);
  model.save_changes();
}

/** Play, back to the start, time, speed, and why it does not go on. */
function transport(model: Model, clock: Clock, listen: Listen): HTMLElement {
  const isPlaying = (): boolean => model.get("playing") as boolean;
  const { button, refresh } = playButton(() => send(model, "playing", !isPlaying()), "");
  const restart = element("button", { type: "button", class: "restart", title: "back to the start" }, "restart");
  restart.addEventListener("click", () => send(model, "_restarts", (model.get("_restarts") as number) + 1));
  const readout = element("output", { class: "now" });
  const showTime = (t: number): void => void (readout.textContent = `${t.toFixed(2)} s`);
  const ended = element("span", { class: "ended", role: "status" });
  const showEnd = (): void => void (ended.textContent = model.get("ended") as string);
  listen("playing", () => refresh(isPlaying()));
  listen("ended", showEnd);
  clock.onTime(showTime, readout);
  refresh(isPlaying());
  showTime(clock.time);
  showEnd();
  return element("div", { class: "transport" }, button, restart, readout, ended, speed(model));
}

function speed(model: Model): HTMLElement {
  const own = model.get("speed") as number;
  const select = element("select", { "aria-label": "Speed" });
  for (const value of [...new Set([...SPEEDS, own])].sort((a, b) => a - b)) {
    const option = element("option", { value: String(value) }, `${Number(value.toPrecision(3))}×`);
    option.selected = value === own;
    select.append(option);
  }
  select.addEventListener("change", () => send(model, "speed", Number(select.value)));
  return element("label", { class: "speed" }, "speed", select);
}

/** A slider for each input. */
function inputs(model: Model, listen: Listen): HTMLElement {
  const list = element("div", { class: "inputs" });
  const values = (): Record<string, number> => model.get("values") as Record<string, number>;
  for (const { name, unit, meaning, low, high } of model.get("_inputs") as Input[]) {
    const slider = element("input", { type: "range", min: "0", max: String(STEPS), step: "1", "aria-label": name });
    const readout = element("output");
    const show = (): void => {
      const value = values()[name];
      readout.textContent = `${Number(value.toPrecision(4))}${unit === "1" ? "" : ` ${unit}`}`;
      // What a hand holds stays where it is.
      if (!slider.matches(":active")) slider.value = String(Math.round(((value - low) / (high - low)) * STEPS));
    };
    slider.addEventListener("input", () => {
      const share = Number(slider.value) / STEPS;
      send(model, "values", { ...values(), [name]: low * (1 - share) + high * share });
      show();
    });
    listen("values", show);
    show();
    list.append(element("label", { title: meaning }, element("span", {}, name), slider, readout));
  }
  return list;
}

export default { render };
