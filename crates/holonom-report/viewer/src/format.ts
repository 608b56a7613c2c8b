// Numbers as people read them.

const SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹";

export function power(exponent: number): string {
  const digits = [...String(Math.abs(exponent))].map((d) => SUPERSCRIPTS[Number(d)]).join("");
  return `10${exponent < 0 ? "⁻" : ""}${digits}`;
}

/** A value under the cursor: four significant digits. */
export function reading(value: number | null | undefined): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e-2 && size < 1e5) return minus(Number.isInteger(value) ? String(value) : value.toPrecision(4));
  const [mantissa, exponent] = value.toExponential(2).split("e");
  return `${minus(mantissa)}·${power(Number(exponent))}`;
}

/** Labels of a linear axis: one common power of ten, decimals as the increment needs them. */
export function ticks(values: number[], increment: number): string[] {
  const largest = Math.max(...values.map(Math.abs));
  if (largest === 0 || (largest >= 1e-2 && largest < 1e5)) {
    const decimals = Math.min(Math.max(-Math.floor(Math.log10(increment) + 1e-9), 0), 12);
    return values.map((v) => minus(v.toFixed(decimals)));
  }
  const exponent = Math.floor(Math.log10(largest));
  const scale = 10 ** exponent;
  const decimals = Math.min(Math.max(-Math.floor(Math.log10(increment / scale) + 1e-9), 0), 8);
  return values.map((v) => (v === 0 ? "0" : `${minus((v / scale).toFixed(decimals))}·${power(exponent)}`));
}

function minus(text: string): string {
  return text.replace("-", "−");
}
