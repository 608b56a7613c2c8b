// Goes in front of everything: remembers what went wrong.
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
