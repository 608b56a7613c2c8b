// Goes behind everything: uses the page as a reader would, and leaves what it saw in #checks.
(async () => {
  const seen = {};
  const frames = async (count) => {
    for (let i = 0; i < count; i++) await new Promise((done) => requestAnimationFrame(done));
  };
  /** How many pixels of a WebGL canvas differ from its first one, and a fingerprint of all. */
  const picture = () => {
    const gl = document.querySelector(".stage canvas").getContext("webgl2");
    const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    const pixels = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let [different, hash] = [0, 0];
    for (let i = 0; i < pixels.length; i += 4) {
      const same = pixels[i] === pixels[0] && pixels[i + 1] === pixels[1] && pixels[i + 2] === pixels[2];
      if (!same) different++;
      hash = (31 * hash + 7 * pixels[i] + 3 * pixels[i + 1] + pixels[i + 2]) | 0;
    }
    return { different, hash };
  };
  const plots = () => [...document.querySelectorAll(".plot canvas")].map((canvas) => canvas.toDataURL());
  const changed = (before, after) => before.filter((image, i) => image !== after[i]).length;
  try {
    await frames(3);
    seen.ready = window.holonom.ready;
    seen.plots = document.querySelectorAll(".plot").length;
    seen.emptyPlots = plots().filter((image) => image.length < 2000).length;
    seen.start = { time: holonom.time(), points: holonom.pointsAt(), bodies: holonom.bodiesAt(), picture: picture() };

    const slider = document.querySelector("input#time");
    slider.value = String(Number(slider.max) / 2);
    slider.dispatchEvent(new Event("input", { bubbles: true }));
    await frames(3);
    seen.middle = { time: holonom.time(), points: holonom.pointsAt(), bodies: holonom.bodiesAt(), picture: picture() };

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

    const field = document.querySelector(".picker input");
    if (field) {
      const titles = () => [...document.querySelectorAll("#machine .plot h3")].map((node) => node.textContent);
      seen.machine = { first: titles(), healthIsOpen: document.querySelector("#health").open, options: document.querySelectorAll("#channels option").length };
      field.value = "crank.power";
      field.dispatchEvent(new Event("input"));
      seen.machine.asked = titles()[0];
      const plain = plots()[0];
      const over = document.querySelector(".asked .meaning input");
      over.value = "hinge.angle";
      over.dispatchEvent(new Event("input"));
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
  seen.faults = faults;
  const node = document.createElement("script");
  node.type = "application/json";
  node.id = "checks";
  node.textContent = JSON.stringify(seen).replaceAll("<", "\\u003c");
  document.body.append(node);
})();
