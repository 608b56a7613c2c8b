// The numbers of the report, as `src/data.rs` writes them.

export type PointKind = "free" | "driven" | "fixed";
export type LineKind = "bar" | "rod" | "spring" | "cylinder" | "rope" | "guide";
export type Vec3 = [number, number, number];
export type Anchor = { point: string } | { fixed: Vec3 } | { body: { body: string; at: Vec3 } };

/** Around the centre of mass; in a planar model along the first and second axis of the plane, and z across it. */
export type Shape =
  | { kind: "box"; size: Vec3 }
  | { kind: "cylinder"; radius: number; length: number }
  | { kind: "sphere"; radius: number }
  | { kind: "rod"; length: number }
  | { kind: "capsule"; radius: number; length: number }
  | { kind: "mesh"; vertices: Vec3[]; triangles: Vec3[] };

export interface Body {
  name: string;
  mass: number;
  shape: Shape | null;
  /** In body axes from the centre of mass, m. */
  places: Vec3[];
}

export interface Joint {
  name: string;
  kind: string;
  /** Carries the place and the axis; null: the world. */
  body: string | null;
  other: string | null;
  at: Vec3;
  axis: Vec3 | null;
  /** Whether the columns of its force are on `other` and not on `body`. */
  acts_on_other: boolean;
  /** Drives and efforts along its coordinates. */
  drives: string[];
  /** Of the disc that rolls, m. */
  radius?: number;
  /** Places along the curve that a point follows, in the axes of `body` or in the world, m. */
  curve?: Vec3[];
}

/** Two wheels with teeth or a belt between them, or a wheel and a rack, which has no radius. */
export interface Wheels {
  name: string;
  kind: "gear" | "belt" | "crossed-belt";
  /** The joints that they turn about. */
  joints: [string, string];
  /** The bodies that they are on; null: the world. */
  bodies: [string | null, string | null];
  /** m */
  radii: [number | null, number | null];
}

export interface Line {
  name: string;
  kind: LineKind;
  from: Anchor;
  to: Anchor;
  /** What a spring acts along where that is not the line itself, in the axes of a body or of the world. */
  along?: { body: string | null; axis: Vec3 };
}

export interface Scene {
  /** "xyz", or the plane of a planar model. */
  axes: string;
  gravity: Vec3;
  points: { name: string; kind: PointKind; mass: number }[];
  lines: Line[];
  bodies: Body[];
  joints: Joint[];
  /** Forces and moments of which columns are recorded. */
  loads: { name: string; at: Anchor }[];
  /** Where they sit on their second body. */
  bushings: { name: string; at: Anchor }[];
  wheels: Wheels[];
}

export interface Run {
  label: string;
  /** Completed with its energy in bounds: axes are scaled to such runs. */
  sound: boolean;
  /** Place in the world from which the places of points, bodies and the scene are counted, m: single precision has too few digits far away from it. */
  origin: Vec3;
  scene: Scene;
  /** Name → one value per row. */
  columns: Map<string, Float64Array>;
  /** Name of a point → coordinates along `scene.axes`, row after row. */
  points: Map<string, Float32Array>;
  /** Name of a body → centre of mass along `scene.axes` and orientation (qw, qx, qy, qz, or the angle in a plane), row after row. */
  bodies: Map<string, Float32Array>;
  /** Times of the rows, s. */
  times: Float64Array;
  /** Events that are marked in plots: their names and times, s. */
  events: [string, number][];
  /** Measures, what acts and joint coordinates, then motion. */
  channels: Channel[];
  channelOf: Map<string, Channel>;
}

/** A recorded column that may be plotted. */
export interface Channel {
  name: string;
  unit: string;
  meaning: string;
  is_measure: boolean;
  values: Float64Array;
  /** Least value, its time, largest value, its time, of all recorded rows. */
  extremes: [number, number, number, number] | null;
}

interface RawRun {
  label: string;
  sound: boolean;
  /** null: that of the first run. */
  scene: Scene | null;
  columns: Record<string, string>;
  points: Record<string, string>;
  bodies: Record<string, string>;
  events: [string, number][];
  channels: (Omit<Channel, "values"> & { values: string; middle: number; scale: number })[];
}

/** What the page holds. */
export interface Payload {
  runs: Run[];
  /** Columns that are plotted first, in place of those that are shown otherwise. */
  columns: string[];
}

export function readPayload(): Payload {
  const text = document.getElementById("holonom-data")?.textContent ?? '{"origin":[0,0,0],"runs":[],"columns":[]}';
  const { origin, runs, columns } = JSON.parse(text) as { origin: Vec3; runs: RawRun[]; columns: string[] };
  return { runs: decodeRuns(runs, origin), columns };
}

/** A scene whose places in the world are counted from there. */
export function seenFromOrigin(scene: Scene, origin: Vec3): Scene {
  const from = (place: Vec3): Vec3 => place.map((x, i) => x - origin[i]) as Vec3;
  const end = (anchor: Anchor): Anchor => ("fixed" in anchor ? { fixed: from(anchor.fixed) } : anchor);
  return {
    ...scene,
    lines: scene.lines.map((line) => ({ ...line, from: end(line.from), to: end(line.to) })),
    joints: scene.joints.map((joint) => (joint.body === null ? { ...joint, at: from(joint.at), curve: joint.curve?.map(from) } : joint)),
    loads: scene.loads.map((load) => ({ ...load, at: end(load.at) })),
    bushings: scene.bushings.map((bushing) => ({ ...bushing, at: end(bushing.at) })),
  };
}

function decodeRuns(runs: RawRun[], origin: Vec3): Run[] {
  return runs.flatMap((raw) => {
    const own = raw.scene ?? runs[0].scene;
    if (!own) return [];
    const scene = seenFromOrigin(own, origin);
    const columns = decodeAll(raw.columns, (bytes) => new Float64Array(bytes));
    const points = decodeAll(raw.points, (bytes) => new Float32Array(bytes));
    const bodies = decodeAll(raw.bodies, (bytes) => new Float32Array(bytes));
    const channels = raw.channels.map(({ middle, scale, ...channel }) => {
      const values = Float64Array.from(new Float32Array(bytesOf(channel.values)), (value) => middle + scale * value);
      return { ...channel, values };
    });
    const channelOf = new Map(channels.map((channel) => [channel.name, channel]));
    return [{ label: raw.label, sound: raw.sound, origin, scene, columns, points, bodies, times: columns.get("t") ?? new Float64Array(), events: raw.events, channels, channelOf }];
  });
}

function decodeAll<T>(coded: Record<string, string>, view: (bytes: ArrayBuffer) => T): Map<string, T> {
  return new Map(Object.entries(coded).map(([name, text]) => [name, view(bytesOf(text))]));
}

/** Numbers are little-endian, like every machine that runs a browser. */
export function bytesOf(base64: string): ArrayBuffer {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes.buffer;
}
