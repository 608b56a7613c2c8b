// The rigid bodies of one run: solids or sketches that follow its motion, with the symbols of their joints.

import { BufferGeometry, Color, Float32BufferAttribute, Group, LineSegments, Mesh, Object3D, SphereGeometry, Vector3 } from "three";
import type { Motion } from "../motion";
import type { Body, Shape } from "../payload";
import type { Theme } from "../theme";
import { addCurves, addJoints } from "./joints";
import { commonAxes, layers } from "./layers";
import { Materials } from "./materials";
import type { Look } from "./looks";
import { extent, outline } from "./outline";
import { mark } from "./pick";
import { sketch, type Pen } from "./sketch";
import { solidOf, type Solid } from "./solid";

/** The width of a link as a share of the size of the picture, and at most of that of an ordinary body. */
const [UNIT, MOST_OF_BODY] = [0.0115, 0.085];
/** Where links are narrower than this share of the picture, they are drawn without the symbols on them. */
const LEGIBLE = 0.0025;

/** Where the parts of a body are hung. */
export interface Frame {
  group: Group;
  /** Which body of the scene it is. */
  index: number;
  /** How far the body lies in front of its true place, m; planar models are drawn in layers. */
  depth: number;
  surface: Mesh;
  isHidden: boolean;
}

export class Bodies {
  readonly group = new Group();
  private readonly symbols: Object3D[] = [];
  private readonly frames = new Map<string, Frame>();
  private readonly materials: Materials;
  private readonly pen: Pen;
  /** The width of things on each body: small bodies have small ones. */
  private readonly units: Map<string, number>;
  private readonly legible: boolean;
  private readonly solids = new Map<Shape | string, Solid>();
  private readonly layers: Map<string, number>;
  private readonly axes: Map<string, Vector3>;

  constructor(private readonly motion: Motion, size: number, runColour: (() => string) | undefined) {
    const { scene } = motion.run;
    this.materials = new Materials(runColour);
    const extents = scene.bodies.map((body) => extent(outline(body, motion.plane)));
    const unit = unitOf(extents, size);
    this.pen = { unit, thickness: unit };
    this.units = new Map(scene.bodies.map(({ name }, i) => [name, Math.min(unit, unitOf([extents[i]], size))]));
    this.legible = unit > LEGIBLE * size;
    this.layers = layers(scene);
    this.axes = commonAxes(motion);
    scene.bodies.forEach((body, index) => this.addBody(body, index));
    if (scene.bodies.length > 0 && this.legible) this.symbols.push(...addJoints(motion, this.pen, this.units, this.materials, this.frames, this.group));
    this.symbols.push(...addCurves(motion, size, this.materials, this.frames, this.group));
  }

  update(t: number): void {
    for (const [name, { group, depth, isHidden }] of this.frames) {
      const pose = isHidden ? undefined : this.motion.poseAt(name, t);
      group.visible = pose !== undefined;
      if (!pose) continue;
      group.position.copy(pose.place).addScaledVector(this.motion.across, depth);
      group.quaternion.copy(pose.turn);
    }
  }

  paint(colours: Theme): void {
    this.materials.paint(colours);
  }

  setLook(body: string, look: Look): void {
    const frame = this.frames.get(body);
    if (!frame) return;
    frame.isHidden = look === "hidden";
    frame.surface.material = look === "transparent" ? this.materials.glass(frame.index) : this.materials.surface(frame.index);
  }

  /** A run that is shown along with another one: transparent, and without symbols. */
  setGhost(ghost: boolean): void {
    this.materials.setGhost(ghost);
    for (const symbol of this.symbols) symbol.visible = !ghost;
  }

  private addBody(body: Body, index: number): void {
    const group = new Group();
    const layer = Math.min(this.layers.get(body.name) ?? 0, 3);
    const depth = this.motion.planar ? -(layer + 0.6) * 1.1 * this.pen.thickness : 0;
    const solid = body.shape ? this.solid(body.shape) : this.sketched(body, layer);
    const surface = new Mesh(solid.surface, this.materials.surface(index));
    const parts = [surface, solid.edges && new LineSegments(solid.edges, this.materials.edge(index))];
    for (const part of parts) {
      if (!part) continue;
      if (body.shape) this.place(part, body.shape);
      group.add(part);
    }
    if (!body.shape && this.legible) group.add(this.centreMark(-depth, this.units.get(body.name) ?? this.pen.unit));
    mark(group, { sort: "body", kind: "body", name: body.name });
    this.group.add(group);
    this.frames.set(body.name, { group, index, depth, surface, isHidden: false });
  }

  /** In a planar model a solid is as thick as a link. */
  private place(part: Mesh | LineSegments, shape: Shape): void {
    part.quaternion.copy(this.motion.plane);
    if (!this.motion.planar || shape.kind === "rod") return;
    part.geometry.computeBoundingBox();
    const thickness = part.geometry.boundingBox?.getSize(new Vector3()).z ?? 0;
    part.scale.z = this.pen.thickness / (thickness || 1);
  }

  private solid(shape: Shape): Solid {
    return this.once(shape.kind === "mesh" ? shape : JSON.stringify(shape), () => solidOf(shape, 0.8 * this.pen.unit));
  }

  private sketched(body: Body, layer: number): Solid {
    const normal = this.motion.planar ? this.motion.across : this.axes.get(body.name);
    // In space neighbours lie in each other, and one shows through as the thinner.
    const unit = this.units.get(body.name) ?? this.pen.unit;
    const thickness = this.motion.planar ? this.pen.thickness : unit * (1.5 - 0.3 * layer);
    const rounded = (place: number[]): number[] => place.map((x) => Math.round(x / (1e-3 * unit)));
    const key = JSON.stringify([body.places.map(rounded), normal?.toArray().map((x) => x.toFixed(5)), unit, thickness]);
    return this.once(key, () => sketch(body.places.map((place) => new Vector3(...place)), normal, { unit, thickness }));
  }

  /** Bodies that look the same share their geometry. */
  private once(key: Shape | string, build: () => Solid): Solid {
    let solid = this.solids.get(key);
    if (!solid) this.solids.set(key, (solid = build()));
    return solid;
  }

  private centreMark(depth: number, unit: number): Mesh {
    const mark = new Mesh(CENTRE_MARK, this.materials.centre);
    mark.scale.setScalar(this.motion.planar ? 0.75 * unit : 0.95 * unit);
    mark.position.copy(this.motion.across).multiplyScalar(this.motion.planar ? depth : 0);
    mark.quaternion.copy(this.motion.plane);
    this.symbols.push(mark);
    return mark;
  }
}

function unitOf(extents: number[], size: number): number {
  const sorted = extents.filter((length) => length > 0).sort((a, b) => a - b);
  const ordinary = sorted[sorted.length >> 1] ?? size;
  return Math.max(Math.min(UNIT * size, MOST_OF_BODY * ordinary), 1e-3 * size);
}

/** The sign for a centre of mass: a ball whose octants are black and white in turn. */
const CENTRE_MARK = ((): BufferGeometry => {
  const ball = new SphereGeometry(1, 32, 16).toNonIndexed();
  const places = ball.getAttribute("position");
  const [black, white] = [new Color(0x14181d), new Color(0xffffff)];
  const colours: number[] = [];
  for (let corner = 0; corner < places.count; corner += 3) {
    const middle = [0, 1, 2].map((k) => new Vector3().fromBufferAttribute(places, corner + k)).reduce((sum, place) => sum.add(place));
    const colour = middle.x * middle.y * middle.z > 0 ? black : white;
    for (let k = 0; k < 3; k++) colours.push(...colour.toArray());
  }
  return ball.setAttribute("color", new Float32BufferAttribute(colours, 3));
})();
