// The numbers of the report, as `src/data.rs` writes them.

export type PointKind = "free" | "driven" | "fixed";
export type LineKind = "bar" | "rod" | "spring" | "guide";
export type Vec3 = [number, number, number];
export type Anchor = { point: string } | { fixed: Vec3 };

export interface Scene {
  /** "xyz", or the plane of a planar model. */
  axes: string;
  gravity: Vec3;
  points: { name: string; kind: PointKind; mass: number }[];
  lines: { name: string; kind: LineKind; from: Anchor; to: Anchor }[];
}

export interface Run {
  label: string;
  /** Completed with its energy in bounds: axes are scaled to such runs. */
  sound: boolean;
  scene: Scene;
  /** Name → one value per row. */
  columns: Map<string, Float64Array>;
  /** Name of a point → coordinates along `scene.axes`, row after row. */
  points: Map<string, Float32Array>;
  /** Times of the rows, s. */
  times: Float64Array;
}

interface RawRun {
  label: string;
  sound: boolean;
  scene: Scene;
  columns: Record<string, string>;
  points: Record<string, string>;
}

export function readPayload(): Run[] {
  const text = document.getElementById("holonom-data")?.textContent ?? '{"runs":[]}';
  const { runs } = JSON.parse(text) as { runs: RawRun[] };
  return runs.map((raw) => {
    const columns = decodeAll(raw.columns, (bytes) => new Float64Array(bytes));
    const points = decodeAll(raw.points, (bytes) => new Float32Array(bytes));
    return { label: raw.label, sound: raw.sound, scene: raw.scene, columns, points, times: columns.get("t") ?? new Float64Array() };
  });
}

function decodeAll<T>(coded: Record<string, string>, view: (bytes: ArrayBuffer) => T): Map<string, T> {
  return new Map(Object.entries(coded).map(([name, text]) => [name, view(bytesOf(text))]));
}

/** Numbers are little-endian, like every machine that runs a browser. */
function bytesOf(base64: string): ArrayBuffer {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes.buffer;
}
