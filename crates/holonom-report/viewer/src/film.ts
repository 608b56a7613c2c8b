// The last rows of a run that goes on, in the form of one that is over.

import { seenFromOrigin, type Run, type Scene, type Vec3 } from "./payload";

/** What frames are made of: the time, then the coordinates of each of these points, then the pose of each of these bodies. */
export interface Layout {
  scene: Scene;
  points: string[];
  bodies: string[];
}

/** Rows that are kept: half a minute of frames. */
const ROWS = 1024;

/** Numbers of one thing, row after row. */
interface Track {
  all: Float32Array;
  width: number;
  into: Map<string, Float32Array>;
  name: string;
}

export class Film {
  readonly run: Run;
  private readonly times = new Float64Array(ROWS);
  private readonly tracks: Track[];
  /** What the coordinates of a place are counted from. */
  private readonly from: number[];
  private rows = 0;

  /** Places are counted from the middle of the first frame. */
  constructor({ scene, points, bodies }: Layout, first: DataView) {
    const axes = [...scene.axes].map((axis) => "xyz".indexOf(axis));
    const pose = axes.length === 2 ? 3 : 7;
    const numbers = numbersOf(first);
    const starts = [...points.map((_, k) => 1 + k * axes.length), ...bodies.map((_, k) => 1 + points.length * axes.length + k * pose)];
    this.from = axes.map((_, i) => starts.reduce((sum, start) => sum + numbers[start + i], 0) / Math.max(starts.length, 1));
    const origin: Vec3 = [0, 0, 0];
    axes.forEach((axis, i) => (origin[axis] = this.from[i]));
    const nothing = { columns: new Map(), events: [], channels: [], channelOf: new Map() };
    this.run = { label: "", sound: true, origin, scene: seenFromOrigin(scene, origin), points: new Map(), bodies: new Map(), times: this.times, ...nothing };
    const track = (width: number, into: Map<string, Float32Array>) => (name: string): Track => ({ all: new Float32Array(ROWS * width), width, into, name });
    this.tracks = [...points.map(track(axes.length, this.run.points)), ...bodies.map(track(pose, this.run.bodies))];
    this.take(first);
  }

  /** Adds a frame. One that is not after the last is of a simulation that was put back, and begins anew. */
  take(frame: DataView): void {
    const numbers = numbersOf(frame);
    const [t] = numbers;
    if (this.rows > 0 && t <= this.times[this.rows - 1]) this.rows = 0;
    if (this.rows === ROWS) this.forget();
    this.times[this.rows] = t;
    let next = 1;
    for (const { all, width } of this.tracks) {
      all.set(numbers.subarray(next, next + width).map((number, i) => number - (this.from[i] ?? 0)), this.rows * width);
      next += width;
    }
    this.rows++;
    this.run.times = this.times.subarray(0, this.rows);
    for (const { all, width, into, name } of this.tracks) into.set(name, all.subarray(0, this.rows * width));
  }

  /** Leaves the older half. */
  private forget(): void {
    const half = ROWS / 2;
    this.times.copyWithin(0, half);
    for (const { all, width } of this.tracks) all.copyWithin(0, half * width);
    this.rows = half;
  }
}

function numbersOf(frame: DataView): Float64Array {
  return new Float64Array(frame.buffer.slice(frame.byteOffset, frame.byteOffset + frame.byteLength));
}
