// Puts the symbols of the joints on the bodies they belong to, and what stands still into the world.

import { Box3, CatmullRomCurve3, Group, Mesh, TubeGeometry, Vector3 } from "three";
import { carried, type Motion } from "../motion";
import type { Anchor, Joint, Wheels } from "../payload";
import type { Frame } from "./bodies";
import { foot } from "./foot";
import { diagonal } from "./frame";
import type { Materials } from "./materials";
import { outline } from "./outline";
import { mark } from "./pick";
import { poseOf, sidesOf, travel, type Side } from "./side";
import type { Pen } from "./sketch";
import { BUSHING, driveOf, RAIL, RAIL_END, railOf, REVERSIBLE, sliderOf, STANDS, symbolOf, type Piece } from "./symbols";
import { disc, sidesOfWheels, wheel } from "./wheels";

const Z = new Vector3(0, 0, 1);

/** The groups that hold the symbols. `units`: the width of things on each body. */
export function addJoints(motion: Motion, pen: Pen, units: Map<string, number>, materials: Materials, frames: Map<string, Frame>, world: Group): Group[] {
  const builder = new JointBuilder(motion, pen, units, materials, frames, world);
  const { joints, wheels, bushings } = motion.run.scene;
  for (const joint of joints) builder.add(joint);
  for (const pair of wheels) builder.addWheels(pair);
  for (const { name, at } of bushings) builder.addBushing(name, at);
  return builder.groups;
}

/** Thickness of a curve over the size of the picture, and most over the curve's own. */
const CURVE = 0.0025;
const CURVE_OF_ITSELF = 0.02;

/** The curves that points follow, as that of a track: parts of the machine, drawn also where symbols would be too small to see. */
export function addCurves(motion: Motion, size: number, materials: Materials, frames: Map<string, Frame>, world: Group): Group[] {
  return motion.run.scene.joints.flatMap(({ name, kind, body, curve }) => {
    const frame = body === null ? undefined : frames.get(body);
    if (!curve || (body !== null && !frame)) return [];
    const points = curve.map((place) => new Vector3(...place));
    const radius = Math.min(CURVE * size, CURVE_OF_ITSELF * diagonal(new Box3().setFromPoints(points)));
    const group = new Group();
    group.add(new Mesh(new TubeGeometry(new CatmullRomCurve3(points), 2 * points.length, radius, 8), materials.part("ground", frame?.index)));
    group.position.addScaledVector(motion.across, -(frame?.depth ?? 0));
    mark(group, { sort: "joint", kind: `${kind} joint`, name });
    (frame?.group ?? world).add(group);
    return [group];
  });
}

class JointBuilder {
  readonly groups: Group[] = [];
  private readonly stood = new Set<string>();

  constructor(
    private readonly motion: Motion,
    /** Of what is added at the moment. */
    private pen: Pen,
    private readonly units: Map<string, number>,
    private readonly materials: Materials,
    private readonly frames: Map<string, Frame>,
    private readonly world: Group,
  ) {}

  add(joint: Joint): void {
    const sides = sidesOf(this.motion, joint);
    if (!sides) return;
    this.sizeBy([joint.body, joint.other]);
    if (REVERSIBLE.has(joint.kind) && joint.other === null) sides.reverse();
    const [here, other] = sides;
    const before = this.groups.length;
    const hub = joint.kind === "revolute" ? this.hubLength(sides) : undefined;
    this.hang(symbolOf(joint.kind), here, hub === undefined ? undefined : new Vector3(1, 1, hub / this.pen.unit));
    const radius = railOf(joint.kind);
    if (radius !== undefined) this.addRail(sides, radius);
    // In a plane, what is held by the slider comes in front of it.
    if (!this.isSolid(other.body)) this.hang(sliderOf(joint.kind), other, undefined, this.motion.planar ? -2 * this.pen.unit : 0);
    if (joint.radius !== undefined && !this.isSolid(other.body)) {
      this.hang([{ geometry: disc(joint.radius / this.pen.unit), part: "body" }], other);
    }
    if (STANDS.has(joint.kind) && (joint.body === null || joint.other === null)) this.addFoot(here, joint.body ?? joint.other, hub);
    for (const group of this.groups.slice(before)) mark(group, { sort: "joint", kind: `${joint.kind} joint`, name: joint.name });
    if (joint.drives.length > 0) this.addDrive(joint, sides, hub ?? 2 * this.pen.unit);
  }

  /** A symbol is as large as the smallest of the bodies that it ties has room for. */
  private sizeBy(bodies: (string | null)[]): void {
    const units = bodies.flatMap((body) => this.units.get(body ?? "") ?? []);
    this.pen = { ...this.pen, unit: Math.min(...(units.length > 0 ? units : [this.pen.thickness])) };
  }

  addWheels(wheels: Wheels): void {
    const before = this.groups.length;
    this.sizeBy(wheels.bodies);
    sidesOfWheels(this.motion, wheels).forEach((side, k) => {
      const radius = wheels.radii[k];
      if (side && radius) this.hang([{ geometry: wheel(radius / this.pen.unit, wheels.kind === "gear"), part: "joint" }], side);
    });
    for (const group of this.groups.slice(before)) mark(group, { sort: "joint", kind: wheels.kind.replace("-", " "), name: wheels.name });
  }

  addBushing(name: string, at: Anchor): void {
    const before = this.groups.length;
    const axis = this.motion.across.clone();
    this.sizeBy(["body" in at ? at.body.body : null]);
    if ("body" in at) this.hang(BUSHING, { body: at.body.body, at: new Vector3(...at.body.at), axis });
    if ("fixed" in at) this.hang(BUSHING, { body: null, at: new Vector3(...at.fixed), axis });
    for (const group of this.groups.slice(before)) mark(group, { sort: "line", kind: "bushing", name });
  }

  private addDrive({ kind, name, drives }: Joint, [here, other]: [Side, Side], hub: number): void {
    const before = this.groups.length;
    const { around, housing, along } = driveOf(kind);
    this.hang(around, here, undefined, this.motion.planar ? 0.5 * hub : 0);
    this.hang(along, other, undefined, this.motion.planar ? 0.5 * hub : 0);
    const end = { ...here, at: here.at.clone().addScaledVector(here.axis, 0.5 * hub) };
    if (!this.motion.planar) this.hang(housing, end);
    for (const group of this.groups.slice(before)) mark(group, { sort: "drive", kind: `drive of ${name}`, name: drives[0] });
  }

  /** Puts pieces at a side of a joint, z along its axis; `depth`: how far in front of the true place, m. */
  private hang(pieces: Piece[], side: Side, scale = new Vector3(1, 1, 1), depth = 0): void {
    const frame = side.body === null ? undefined : this.frames.get(side.body);
    if (pieces.length === 0 || (side.body !== null && !frame)) return;
    const group = new Group();
    for (const { geometry, part } of pieces) group.add(new Mesh(geometry, this.materials.part(part, frame?.index)));
    group.scale.copy(scale).multiplyScalar(this.pen.unit);
    group.quaternion.setFromUnitVectors(Z, side.axis);
    // Bodies of a planar model lie in layers behind its plane, and joints in front of all of them.
    group.position.copy(side.at).addScaledVector(this.motion.across, depth - (frame?.depth ?? 0));
    (frame?.group ?? this.world).add(group);
    this.groups.push(group);
  }

  /** Long enough to come out of the solids it joins. */
  private hubLength(sides: [Side, Side]): number {
    const { unit } = this.pen;
    if (this.motion.planar) return 2.4 * unit;
    const reach = sides.map(({ body, at, axis }) => {
      const solid = this.motion.run.scene.bodies.find((other) => other.name === body && other.shape);
      // Of a link half its thickness.
      if (!solid) return 0.75 * (this.units.get(body ?? "") ?? 0);
      const { places, round } = outline(solid, this.motion.plane);
      const along = places.map((place) => Math.abs(new Vector3(...place).sub(at).dot(axis)));
      return Math.max(...along) + round;
    });
    return Math.min(Math.max(3.6 * unit, 2 * Math.max(...reach) + 1.6 * unit), 14 * unit);
  }

  /** A rail along the way that the other side goes, with blocks at its ends where it is held in the world. */
  private addRail(sides: [Side, Side], radius: number): void {
    const { unit, thickness } = this.pen;
    const [least, most] = travel(this.motion, sides);
    const [low, high] = [least - 5 * unit, most + 5 * unit];
    const [here] = sides;
    const at = (along: number): Side => ({ ...here, at: here.at.clone().addScaledVector(here.axis, along) });
    // In a plane, what slides on it comes in front.
    const depth = this.motion.planar ? -5 * thickness : 0;
    this.hang(RAIL, at((low + high) / 2), new Vector3(radius, radius, (high - low) / unit), depth);
    if (here.body !== null) return;
    for (const end of [low, high]) this.hang(RAIL_END, at(end), undefined, depth);
  }

  /** `body`: what is held. */
  private addFoot(here: Side, body: string | null, hub: number | undefined): void {
    const pose = poseOf(this.motion, here.body, 0);
    if (!pose) return;
    const side: Side = { body: null, at: carried(pose, here.at.toArray()), axis: here.axis.clone().applyQuaternion(pose.turn) };
    // One is enough where several joints are in the same place.
    const key = side.at.toArray().map((x) => Math.round(x / (0.1 * this.pen.unit))).join();
    if (this.stood.has(key)) return;
    this.stood.add(key);
    const group = foot(this.motion, side, body, hub, this.pen, this.materials.part("ground", undefined));
    this.world.add(group);
    this.groups.push(group);
  }

  private isSolid(body: string | null): boolean {
    return this.motion.run.scene.bodies.some((other) => other.name === body && other.shape !== null);
  }
}
