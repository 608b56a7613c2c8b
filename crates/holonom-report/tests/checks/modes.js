// Goes behind everything: looks at the modes as a reader would, and leaves what it saw in #checks.
const seen = { faults, rows: [], pictures: [], labels: [], keys: [] };
const picture = async () => {
  await frames(3);
  return pictureOf(document.querySelector("canvas")).hash;
};
const press = (key) => document.body.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
const amplitude = (value) => {
  const slider = document.querySelector(".transport input");
  slider.value = value;
  slider.dispatchEvent(new Event("input", { bubbles: true }));
};
const chosen = () => [...document.querySelectorAll(".modes tbody tr")].findIndex((row) => row.getAttribute("aria-selected") === "true");
const look = async () => {
  seen.rows.push(chosen());
  seen.labels.push(document.querySelector(".transport output").textContent);
  seen.pictures.push(await picture());
};
const all = [...document.querySelectorAll(".modes tbody tr")];

(async () => {
  try {
    const play = document.querySelector(".play");
    seen.keys.push(play.getAttribute("aria-label"));
    const before = holonom.time();
    await frames(10);
    seen.playing = holonom.time() - before;
    press(" ");
    seen.keys.push(play.getAttribute("aria-label"));
    // Half a period apart, a quarter after rest, and with no amplitude.
    seen.places = [0.5, 1.5, 0].map((t) => (holonom.setTime(t), holonom.bodiesAt()));
    holonom.setTime(0.5);
    await look();
    all[1].click();
    await look();
    press("ArrowDown");
    await look();
    press("ArrowUp");
    press("ArrowUp");
    press("ArrowUp");
    amplitude("0");
    await look();
    seen.rest = holonom.bodiesAt();
    seen.scrolled = [scrollY, document.documentElement.scrollWidth <= innerWidth];
  } catch (error) {
    seen.faults.push(String(error.stack ?? error));
  }
  leave(seen);
})();
