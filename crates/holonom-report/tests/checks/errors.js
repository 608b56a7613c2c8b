// Goes in front of everything: remembers what went wrong, and supplies frames.
window.faults = [];
addEventListener("error", (event) => faults.push(String(event.message ?? event)));
addEventListener("unhandledrejection", (event) => faults.push(String(event.reason)));
addEventListener("securitypolicyviolation", (event) => faults.push(`would load ${event.blockedURI}`));
for (const level of ["error", "warn"]) {
  const original = console[level].bind(console);
  console[level] = (...words) => {
    faults.push(`console.${level}: ${words.join(" ")}`);
    original(...words);
  };
}

// What is written in plots is in no element.
window.written = new Set();
const { fillText } = CanvasRenderingContext2D.prototype;
CanvasRenderingContext2D.prototype.fillText = function (text, ...place) {
  written.add(text);
  fillText.call(this, text, ...place);
};

// A browser without a screen draws hardly any frame while its virtual time runs; timers do run.
window.requestAnimationFrame = (act) => setTimeout(() => act(performance.now()), 16);
