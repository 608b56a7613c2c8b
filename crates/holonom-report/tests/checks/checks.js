// Goes behind everything: uses the page as a reader would, and leaves what it saw in #checks.
(async () => {
  const seen = {};
  const picture = () => pictureOf(document.querySelector(".stage canvas"));
  const moment = () => {
    const bodies = holonom.bodiesAt();
    const screen = Object.values(bodies).map((place) => holonom.onScreen(place));
    return { time: holonom.time(), points: holonom.pointsAt(), bodies, screen, picture: picture() };
  };
  const plots = () => [...document.querySelectorAll(".plot canvas")].map((canvas) => canvas.toDataURL());
  const changed = (before, after) => before.filter((image, i) => image !== after[i]).length;
  try {
    await frames(3);
    seen.ready = window.holonom.ready;
    seen.plots = document.querySelectorAll(".plot").length;
    seen.emptyPlots = plots().filter((image) => image.length < 2000).length;
    seen.start = moment();
    {
      const first = document.querySelector(".plot .u-over");
      const over = first?.getBoundingClientRect();
      seen.events = [...(first?.querySelectorAll(".event") ?? [])].map((line) => {
        const { left, width } = line.getBoundingClientRect();
        return [line.title, Math.round((100 * (left + width / 2 - over.left)) / over.width)];
      });
      const rectangle = (place) => document.querySelector(place)?.getBoundingClientRect() ?? {};
      const [choice, tools, stage] = [".stage .choice select", ".stage .tools", ".stage"].map(rectangle);
      seen.layout = {
        legendFits: [...document.querySelectorAll("#legend button")].every((button) => button.getBoundingClientRect().right <= innerWidth),
        choiceIsFree: choice.right <= tools.left || choice.top >= tools.bottom,
        choiceFits: choice.right <= stage.right,
      };
    }

    const slider = document.querySelector("input#time");
    slider.value = String(Number(slider.max) / 2);
    slider.dispatchEvent(new Event("input", { bubbles: true }));
    await frames(3);
    seen.middle = moment();

    holonom.setTime(1e9);
    await frames(3);
    seen.end = { time: holonom.time(), slider: slider.value === slider.max };
    holonom.setTime(0);
    document.querySelector(".play").click();
    await new Promise((done) => setTimeout(done, 300));
    seen.playing = holonom.time();
    document.querySelector(".play").click();

    const press = (key, target = document.body) => target.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
    const label = () => document.querySelector(".play").getAttribute("aria-label");
    const typed = document.querySelector(".picker input, .transport select");
    holonom.setTime(0);
    seen.keys = [press(" "), label()];
    press(" ", typed);
    seen.keys.push(label(), press(" "), label());
    holonom.setTime(0);
    for (const key of ["ArrowRight", "ArrowRight", "ArrowLeft"]) press(key, slider);
    press("ArrowRight", typed);
    seen.stepped = holonom.time();

    seen.beyond = [...document.querySelectorAll(".beyond")].map((node) => node.textContent);
    seen.samples = document.querySelectorAll("table .swatch svg line").length;
    const choice = document.querySelector(".choice select");
    if (choice && !choice.parentElement.hidden) {
      const shown = () => [choice.value, picture().hash];
      seen.choice = { options: choice.options.length, first: shown() };
      choice.value = "1";
      choice.dispatchEvent(new Event("change"));
      await frames(3);
      seen.choice.second = shown();
    }
    const over = document.querySelector(".u-over");
    if (over) {
      const { left, top, width } = over.getBoundingClientRect();
      over.dispatchEvent(new PointerEvent("pointermove", { clientX: left + width / 4, clientY: top + 20 }));
      const readout = document.querySelector(".readout");
      seen.readout = readout && { names: [...readout.querySelectorAll("span:not(.value)")].map((node) => node.textContent), hidden: readout.hidden };
      over.dispatchEvent(new PointerEvent("pointerleave"));
      if (readout) seen.readout.left = readout.hidden;
    }

    const isColumn = (name) => document.querySelector(`#channels option[value="${name}"]`) !== null;
    const field = document.querySelector(".picker input");
    if (isColumn("crank.power")) {
      const titles = () => [...document.querySelectorAll("#machine .plot h3")].map((node) => node.textContent);
      seen.machine = { first: titles(), healthIsOpen: document.querySelector("#health").open, options: document.querySelectorAll("#channels option").length };
      field.value = "crank.power";
      field.dispatchEvent(new Event("input"));
      seen.machine.asked = titles()[0];
      const plain = plots()[0];
      const over = document.querySelector(".asked .meaning input");
      over.value = "inge.ang";
      over.dispatchEvent(new KeyboardEvent("keyup", { key: "Enter" }));
      await frames(3);
      seen.machine.over = [titles()[0], plots()[0] !== plain && plots()[0].length > 2000];
      const drawing = document.querySelector(".asked .u-over");
      const { left, bottom, width } = drawing.getBoundingClientRect();
      drawing.dispatchEvent(new PointerEvent("pointermove", { clientX: left + width / 2, clientY: bottom - 20 }));
      seen.machine.pointed = document.querySelector(".asked .readout").innerText;
      seen.machine.extremes = [...document.querySelectorAll(".extremes tbody tr")].map((row) => row.innerText.split(/\s+/).join(" "));
      document.querySelectorAll(".extremes tbody tr").forEach((row) => row.innerText.startsWith("lift") && row.querySelectorAll("button")[1].click());
      seen.machine.wentTo = holonom.time();
      document.querySelector(".asked .remove").click();
      seen.machine.left = titles().length;
    }

    if (isColumn("crank.power") && !document.querySelector("#legend button")) {
      // What browsers do beside the page, encoding and reading, need not end in virtual time: here it is done at once.
      const taken = [];
      window.Blob = class extends Blob {
        constructor(parts, options) {
          super(parts, options);
          this.parts = parts;
        }
      };
      HTMLCanvasElement.prototype.toBlob = function (done, type) {
        const content = new Blob([this.toDataURL(type)], { type });
        done(Object.assign(content, { picture: [type, content.size > 2000, this.width, this.height] }));
      };
      const address = URL.createObjectURL;
      URL.createObjectURL = (content) => (taken.push({ content }), address(content));
      HTMLAnchorElement.prototype.click = function () {
        Object.assign(taken.at(-1), { name: this.download });
      };
      for (const button of document.querySelectorAll(".picker .take, .stage .take, #machine .plot .take")) button.click();
      const numbers = taken.splice(1, 1)[0];
      seen.taken = {
        names: [numbers, ...taken].map(({ name }) => name),
        numbers: numbers.content.parts.join(""),
        pictures: taken.map(({ content }) => content.picture),
      };
    }

    if (isColumn("b.fx")) {
      const canvas = document.querySelector(".stage canvas");
      // Events made here belong to no pointer that could be captured.
      canvas.setPointerCapture = canvas.releasePointerCapture = () => {};
      const point = (type, [x, y]) => canvas.dispatchEvent(new PointerEvent(type, { clientX: x, clientY: y, bubbles: true }));
      const name = async (place) => {
        point("pointermove", place);
        await frames(2);
        return document.querySelector(".stage .name:not([hidden])")?.textContent ?? "";
      };
      const click = async (place) => {
        for (const type of ["pointerdown", "pointerup"]) point(type, place);
        await frames(3);
      };
      const text = (selector) => [...document.querySelectorAll(selector)].filter((node) => !node.hidden).map((node) => node.textContent);
      const forces = () => text(".stage .forces div");
      const titles = () => text("#machine .plot h3");
      holonom.setTime(0);
      const places = holonom.bodiesAt();
      const middle = (from, to) => holonom.onScreen(from.map((x, i) => 0.5 * (x + to[i])));
      const [hinge, held] = [holonom.onScreen([0, 0, 0]), [1.6, 0, -0.5]];
      const pin = holonom.onScreen([0.35, 0, 0]);
      seen.picked = { names: [await name(holonom.onScreen(places.coupler)), await name(middle(held, places.rocker)), await name(middle(held, [1.6, 0, 0.4]))] };
      const around = new Set();
      for (let x = -40; x <= 40; x += 4) around.add(await name([hinge[0] + x, hinge[1]]));
      seen.picked.aroundHinge = [...around];
      const towards = () => {
        const { left, top } = [...document.querySelectorAll(".stage .forces div")].find((node) => node.textContent.startsWith("b ")).getBoundingClientRect();
        return [left - pin[0], top - pin[1]];
      };
      seen.picked.first = titles();
      await click(holonom.onScreen(places.coupler));
      Object.assign(seen.picked, { selected: text(".selected")[0], plots: titles().slice(0, 3), forces: forces(), towards: towards() });
      await click(middle([0, 0, 0], [0.35, 0, 0]));
      Object.assign(seen.picked, { crankForces: forces(), towardsCrank: towards() });
      await click(middle(held, places.rocker));
      seen.picked.strut = forces();
      press("Escape");
      await frames(2);
      seen.picked.cleared = [text(".selected").length === 0, forces(), titles()];
      const joint = [2 * places.rocker[0] - 1, 0, 2 * places.rocker[2] - 0.1];
      await click(holonom.onScreen(joint));
      seen.picked.joint = text(".selected")[0];
      press("Escape");

      const switches = [...document.querySelectorAll(".looks [data-look]")];
      const coupler = switches.find((button) => button.title.includes("coupler"));
      seen.looks = { words: [], pictures: [], under: [] };
      for (let k = 0; k < 4; k++) {
        await frames(3);
        seen.looks.words.push(coupler.textContent);
        seen.looks.pictures.push(picture().hash);
        const under = await name(holonom.onScreen(places.coupler));
        seen.looks.under.push(under.startsWith("coupler") ? under : "");
        if (k < 3) coupler.click();
      }
      switches[0].click();
      switches[0].click();
      seen.looks.all = text('.looks [data-look="hidden"]').length - 1;
      switches[0].click();
    }

    const home = document.querySelector(".stage .home");
    if (home) {
      holonom.setTime(0);
      const canvas = document.querySelector(".stage canvas");
      const { left, top } = canvas.getBoundingClientRect();
      const turns = [() => home.click(), () => canvas.dispatchEvent(new WheelEvent("wheel", { deltaY: -300, clientX: left + 50, clientY: top + 50, bubbles: true, cancelable: true })), () => home.click()];
      seen.home = [];
      for (const turn of turns) {
        turn();
        await frames(3);
        seen.home.push(Object.values(holonom.bodiesAt()).map((place) => holonom.onScreen(place).map(Math.round)));
      }
    }

    const before = plots();
    await frames(3);
    const legend = document.querySelector("#legend button, button.entry");
    if (legend) {
      legend.click();
      await frames(3);
      seen.legend = { pressed: legend.getAttribute("aria-pressed"), changed: changed(before, plots()) };
      legend.click();
      await frames(3);
      seen.legendBack = changed(before, plots());
      legend.dispatchEvent(new PointerEvent("pointerenter"));
      await frames(3);
      seen.highlighted = changed(before, plots());
      legend.dispatchEvent(new PointerEvent("pointerleave"));
      legend.dispatchEvent(new MouseEvent("dblclick"));
      seen.only = document.querySelectorAll('#legend [aria-pressed="true"]').length;
      document.querySelector("#legend .all")?.click();
      await frames(3);
      seen.all = [document.querySelectorAll('#legend [aria-pressed="true"]').length, changed(before, plots())];
    }
  } catch (fault) {
    faults.push(String(fault.stack ?? fault));
  }
  seen.written = [...written];
  seen.faults = faults;
  leave(seen);
})();
