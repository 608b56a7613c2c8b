// Play, scrub, speed.

import type { Clock } from "./clock";
import { element } from "./dom";

const STEPS = 10_000;
const PLAY = "M4 2.5v11l9.5-5.5z";
const PAUSE = "M3.5 2.5h3v11h-3zM9.5 2.5h3v11h-3z";

export function buildTransport(clock: Clock): HTMLElement {
  const { button, refresh } = playButton(() => clock.toggle(), " (space bar); arrow keys step");
  clock.onPlaying(refresh);
  refresh(false);
  const slider = timeSlider(clock);
  const readout = element("output", { for: "time" });
  const digits = decimals(clock.end - clock.start);
  const show = (t: number): void => {
    readout.textContent = `${t.toFixed(digits)} / ${clock.end.toFixed(digits)} s`;
  };
  clock.onTime(show);
  show(clock.time);
  return element("div", { class: "transport" }, button, slider, readout, speedSelect(clock));
}

/** A button that shows what a click does; `keys` are told with it. */
export function playButton(toggle: () => void, keys: string): { button: HTMLElement; refresh: (playing: boolean) => void } {
  const button = element("button", { type: "button", class: "play" });
  const refresh = (playing: boolean): void => {
    button.setAttribute("aria-label", playing ? "Pause" : "Play");
    button.title = `${playing ? "pause" : "play"}${keys}`;
    button.innerHTML = `<svg viewBox="0 0 16 16" aria-hidden="true"><path d="${playing ? PAUSE : PLAY}"/></svg>`;
  };
  button.addEventListener("click", toggle);
  return { button, refresh };
}

function timeSlider(clock: Clock): HTMLElement {
  // A whole number of steps: rounding cannot keep the slider from its end.
  const slider = element("input", { type: "range", id: "time", min: "0", max: String(STEPS), step: "1", value: "0", "aria-label": "Time" });
  const span = clock.end - clock.start || 1;
  slider.addEventListener("input", () => {
    clock.pause();
    clock.setTime(clock.start + (Number(slider.value) / STEPS) * span);
  });
  clock.onTime((t) => {
    slider.value = String(Math.round(((t - clock.start) / span) * STEPS));
  });
  return slider;
}

function speedSelect(clock: Clock): HTMLElement {
  const select = element("select", { "aria-label": "Speed" });
  for (const factor of [0.1, 0.25, 0.5, 1, 2, 5, 10]) {
    const speed = clock.speed * factor;
    const option = element("option", { value: String(speed) }, `${Number(speed.toPrecision(3))}×`);
    option.selected = factor === 1;
    select.append(option);
  }
  select.addEventListener("change", () => (clock.speed = Number(select.value)));
  return element("label", { class: "speed" }, "speed", select);
}

/** Four digits of the whole duration. */
function decimals(duration: number): number {
  return Math.min(Math.max(3 - Math.floor(Math.log10(duration || 1)), 0), 7);
}
