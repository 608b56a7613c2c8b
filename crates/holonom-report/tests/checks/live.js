// A notebook of a few lines: shares values with the widget, shows it, uses it as a reader would, and leaves what it saw in #checks.
import widget from "SCRIPT";

// The browser's clock is a virtual one that does not wait for frames; it does for timers.
window.requestAnimationFrame = (act) => setTimeout(() => act(performance.now()), 16);

const given = GIVEN;
const seen = { faults: [], pictures: [], times: [], sent: [], slider: [] };
window.addEventListener("error", (event) => seen.faults.push(event.message));
window.addEventListener("unhandledrejection", (event) => seen.faults.push(String(event.reason)));

const viewOf = (numbers) => new DataView(new Float64Array(numbers).buffer);
const values = {
  _layout: given.layout,
  _style: given.style,
  _frame: viewOf(given.frames[0]),
  _inputs: [{ name: "torque", unit: "N·m", meaning: "of the motor", low: -5, high: 5 }],
  _restarts: 0,
  values: { torque: 0 },
  playing: false,
  speed: 1,
  ended: "",
};
const listeners = new Map();
const count = () => [...listeners.values()].flat().length;
let changed = {};
const model = {
  get: (name) => values[name],
  set: (name, value) => (changed[name] = values[name] = value),
  save_changes: () => {
    seen.sent.push(changed);
    changed = {};
  },
  on: (event, act) => listeners.set(event, [...(listeners.get(event) ?? []), act]),
  off: (event, act) => listeners.set(event, listeners.get(event).filter((other) => other !== act)),
};
const fromKernel = (name, value) => {
  values[name] = value;
  for (const act of listeners.get(`change:${name}`) ?? []) act();
};
try {
  const cell = document.querySelector("#cell");
  const end = widget.render({ model, el: cell });
  const root = cell.shadowRoot;
  const look = async () => {
    await frames(3);
    seen.pictures.push(pictureOf(root.querySelector("canvas")));
    seen.times.push(root.querySelector("output.now").textContent);
  };
  await look();
  fromKernel("_frame", viewOf(given.frames[2]));
  await look();
  fromKernel("_frame", viewOf(given.frames[0]));
  await look();

  root.querySelector(".play").click();
  fromKernel("playing", true);
  seen.button = root.querySelector(".play").getAttribute("aria-label");
  root.querySelector(".restart").click();
  const [slider, told] = root.querySelectorAll(".inputs input, .inputs output");
  seen.slider.push(told.textContent);
  slider.value = "750";
  slider.dispatchEvent(new Event("input", { bubbles: true }));
  seen.slider.push(told.textContent);
  fromKernel("values", { torque: -5 });
  seen.slider.push(told.textContent, slider.value);
  const speed = root.querySelector(".speed select");
  speed.value = "2";
  speed.dispatchEvent(new Event("change", { bubbles: true }));
  fromKernel("ended", "it ended");
  seen.ended = root.querySelector(".ended").textContent;
  seen.outside = getComputedStyle(document.body).backgroundColor;
  const before = count();
  end();
  seen.listeners = [before, count()];
} catch (error) {
  seen.faults.push(String(error.stack ?? error));
}
leave(seen);
