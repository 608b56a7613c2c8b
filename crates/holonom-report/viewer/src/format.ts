// Numbers as people read them.

const SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹";

export function power(exponent: number): string {
  const digits = [...String(Math.abs(exponent))].map((d) => SUPERSCRIPTS[Number(d)]).join("");
  return `10${exponent < 0 ? "⁻" : ""}${digits}`;
}

/** A value under the cursor: four significant digits, or so many. */
export function reading(value: number | null | undefined, digits = 4): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e-2 && size < 1e5) return minus(Number.isInteger(value) ? String(value) : value.toFixed(Math.max(digits - 1 - Math.floor(Math.log10(size)), 0)));
  const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
  return `${minus(mantissa)}·${power(Number(exponent))}`;
}

/** A share of the largest that is round-off. */
const ROUND_OFF = 1e-12;

/** A value beside the largest of its kind: nothing where it is round-off of that. */
export function cleared(value: number, largest: number): number {
  return Math.abs(value) < ROUND_OFF * largest ? 0 : value;
}

/** A value between two others: of what changes by a small share of itself so many digits that this shows. */
export function readingBetween(value: number, low: number, high: number): string {
  const shares = Math.floor(Math.log10(Math.max(Math.abs(low), Math.abs(high)) / (high - low)));
  return reading(value, 4 + Math.min(Math.max(Number.isFinite(shares) ? shares - 1 : 0, 0), 9));
}

/** A number in full: with as few digits as tell it from its neighbours, of single precision if it is one of these. */
export function shortest(value: number): string {
  if (Math.fround(value) !== value) return String(value);
  for (let digits = 6; digits < 9; digits++) {
    const rounded = Number(value.toPrecision(digits));
    if (Math.fround(rounded) === value) return String(rounded);
  }
  return String(Number(value.toPrecision(9)));
}

/** Labels of a linear axis: one common power of ten, decimals as the increment needs them. */
export function ticks(values: number[], increment: number): string[] {
  const largest = Math.max(...values.map(Math.abs));
  if (largest === 0) return values.map(() => "0");
  if (largest >= 1e-2 && largest < 1e5) {
    const digits = decimals(increment);
    return values.map((v) => minus(v.toFixed(digits)));
  }
  const exponent = Math.floor(Math.log10(largest));
  const scale = 10 ** exponent;
  const digits = decimals(increment / scale);
  return values.map((v) => (v === 0 ? "0" : `${minus((v / scale).toFixed(digits))}·${power(exponent)}`));
}

/** As many as it takes to write multiples of the increment; 2.5 takes one. */
function decimals(increment: number): number {
  for (let digits = 0; digits < 12; digits++) {
    const scaled = increment * 10 ** digits;
    if (scaled > 0.5 && Math.abs(scaled - Math.round(scaled)) < 1e-6 * scaled) return digits;
  }
  return 12;
}

function minus(text: string): string {
  return text.replace("-", "−");
}
