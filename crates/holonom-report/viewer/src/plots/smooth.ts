// Curves that many runs can share a plot with.

/** Windows per run. */
export const WINDOWS = 100;

/** The largest size around each row: what is asked of an error is how large it gets. */
export function envelope(values: Float64Array): Float64Array {
  return overWindows(values, (window) => window.reduce((most, value) => Math.max(most, Math.abs(value)), 0));
}

export function mean(values: Float64Array): Float64Array {
  return overWindows(values, (window) => window.reduce((sum, value) => sum + value, 0) / window.length);
}

/** The first row, which is before the first step, takes no part: it has no error and no iterations yet. */
function overWindows(values: Float64Array, represent: (window: Float64Array) => number): Float64Array {
  const reach = Math.max(Math.floor(values.length / WINDOWS / 2), 1);
  return values.map((_, row) => (values.length < 2 ? represent(values) : represent(values.subarray(Math.max(row - reach, 1), row + reach + 1))));
}
