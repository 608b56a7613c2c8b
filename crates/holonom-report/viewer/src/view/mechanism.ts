// One run's mechanism: points, what connects them, bodies, and trails.

import { BackSide, BoxGeometry, BufferGeometry, Color, CylinderGeometry, FrontSide, Group, Line, LineBasicMaterial, Mesh, MeshStandardMaterial, Quaternion, SphereGeometry, Vector3, type Side } from "three";
import type { Motion } from "../motion";
import type { Anchor, Line as SceneLine, Scene, Vec3, Wheels } from "../payload";
import { bodyColor, curveColor, theme, type Theme } from "../theme";
import { Bodies } from "./bodies";
import { Cylinder } from "./cylinder";
import type { Look } from "./looks";
import { extent, outline } from "./outline";
import { mark } from "./pick";
import { coil, stick, stretch } from "./shapes";
import { Trail } from "./trail";
import { sidesOfWheels, straightParts } from "./wheels";

/** More would be a tangle. */
const MOST_TRAILS = 16;

/** Rows that are looked at for the shortest length of a cylinder. */
const SAMPLES = 400;

/** What is shorter than this share of the picture, or ties a body that is, is drawn as much thinner, but for the least. */
const [ORDINARY, LEAST] = [0.15, 0.15];

/** Radii as shares of the size of the whole picture. */
const RADIUS = { bar: 0.0095, pin: 0.0135, rod: 0.0038, spring: 0.016, wire: 0.0028, rope: 0.0025, belt: 0.0032, point: 0.017, ground: 0.026 };

export class Mechanism {
  readonly group = new Group();
  private readonly updates: ((t: number) => void)[] = [];
  private readonly paints: ((colours: Theme) => void)[] = [];
  /** Colour of the run when several are compared. */
  private readonly runColour: (() => string) | undefined;
  /**
   * Runs that coincide must neither flicker nor hide each other. The first is a solid; each of the others is a little larger, and
   * only its far side is drawn: alone it looks like a solid, around another one like a rim.
   */
  private readonly side: Side;
  private readonly scale: number;
  private readonly scene: Scene;
  private readonly bodies: Bodies;
  /** How far bodies reach, by name, m. */
  private readonly extents: Map<string, number>;
  /** Of the lines that end at a place. */
  private readonly thinnest = new Map<string, number>();
  /** Those of bodies, by name. */
  private readonly trails = new Map<string, Trail>();

  constructor(readonly motion: Motion, private readonly size: number, index: number, runs: number) {
    this.scene = motion.run.scene;
    this.runColour = runs > 1 ? () => curveColor(index) : undefined;
    this.scale = size * (1 + (0.8 * index) / runs);
    this.side = index === 0 ? FrontSide : BackSide;
    this.extents = new Map(this.scene.bodies.map((body) => [body.name, extent(outline(body, motion.plane))]));
    for (const { kind, from, to } of this.scene.lines) {
      const thinness = kind === "guide" ? 1 : this.thinness([from, to]);
      for (const key of [from, to].map((end) => JSON.stringify(end))) this.thinnest.set(key, Math.min(thinness, this.thinnest.get(key) ?? 1));
    }
    for (const line of this.scene.lines) this.addLine(line);
    for (const wheels of this.scene.wheels) this.addBelt(wheels);
    this.addPins();
    this.addPoints();
    this.addGround();
    this.bodies = this.addBodies();
    this.addTrails();
  }

  update(t: number): void {
    for (const update of this.updates) update(t);
  }

  paint(): void {
    const colours = theme();
    for (const paint of this.paints) paint(colours);
  }

  /** Shown along with another run. */
  setGhost(ghost: boolean): void {
    this.bodies.setGhost(ghost);
  }

  setLook(body: string, look: Look): void {
    this.bodies.setLook(body, look);
    const trail = this.trails.get(body);
    if (trail) trail.isHidden = look === "hidden";
  }

  private addLine({ name, kind, from, to }: SceneLine): void {
    if (kind === "guide") return this.addGuide(from, to);
    if (kind === "cylinder") return this.addCylinder(name, from, to);
    const start = this.ends(from, to, this.motion.run.times[0] ?? 0);
    const natural = kind === "spring" ? Math.max(start ? start[0].distanceTo(start[1]) : 0, this.scale * 0.05) : 1;
    const scale = this.scale * this.thinness([from, to]);
    const geometry = kind === "spring" ? coil(RADIUS.spring * scale, RADIUS.wire * scale, natural) : stick(RADIUS[kind] * scale);
    const mesh = this.solid(geometry, (colours) => this.runColour?.() ?? colours[kind]);
    mark(mesh, { sort: "line", kind, name });
    this.updates.push((t) => {
      const ends = this.ends(from, to, t);
      mesh.visible = ends !== undefined && stretch(mesh, ends[0], ends[1], natural);
    });
  }

  /** The straight parts; the wheels are drawn with the joints. */
  private addBelt(wheels: Wheels): void {
    const sides = sidesOfWheels(this.motion, wheels).filter((side) => side !== undefined);
    if (wheels.kind === "gear" || sides.length < 2) return;
    const meshes = [0, 1].map(() => this.solid(stick(RADIUS.belt * this.scale), (colours) => this.runColour?.() ?? colours.rope));
    for (const mesh of meshes) mark(mesh, { sort: "joint", kind: "belt", name: wheels.name });
    this.updates.push((t) => {
      const parts = straightParts(this.motion, wheels, sides, t);
      meshes.forEach((mesh, k) => (mesh.visible = k < parts.length && stretch(mesh, ...parts[k])));
    });
  }

  private addCylinder(name: string, from: Anchor, to: Anchor): void {
    const { times } = this.motion.run;
    const step = Math.max(1, Math.floor(times.length / SAMPLES));
    let shortest = Infinity;
    for (let row = 0; row < times.length; row += step) {
      const ends = this.ends(from, to, times[row]);
      if (ends) shortest = Math.min(shortest, ends[0].distanceTo(ends[1]));
    }
    if (!Number.isFinite(shortest)) return;
    const [barrel, rod] = [this.material((colours) => this.runColour?.() ?? colours.bar), this.material((colours) => colours.pin)];
    const cylinder = new Cylinder(Math.max(shortest, 0.02 * this.scale), this.scale, barrel, rod);
    mark(cylinder.group, { sort: "line", kind: "cylinder", name });
    this.group.add(cylinder.group);
    this.updates.push((t) => {
      const ends = this.ends(from, to, t);
      cylinder.group.visible = ends !== undefined && cylinder.put(...ends);
    });
  }

  /** Pins at the ends of bars that have room for them, but where a point has a ball of its own. */
  private addPins(): void {
    const hasRoom = ({ from, to }: SceneLine): boolean => {
      const ends = this.ends(from, to, this.motion.run.times[0] ?? 0);
      return ends !== undefined && ends[0].distanceTo(ends[1]) > 4 * RADIUS.pin * this.scale * this.thinness([from, to]);
    };
    const balls = new Set(this.scene.points.filter(({ kind, mass }) => kind === "driven" || (kind === "free" && mass > 0)).map(({ name }) => name));
    const ends = this.scene.lines.filter((line) => line.kind === "bar" && hasRoom(line)).flatMap(({ name, from, to }) => {
      const thinness = this.thinness([from, to]);
      return [from, to].map((anchor) => ({ name, anchor, thinness }));
    });
    const places = new Map(ends.map((end) => [JSON.stringify(end.anchor), end]));
    for (const { name, anchor, thinness } of places.values()) {
      if ("point" in anchor && balls.has(anchor.point)) continue;
      for (const mesh of this.pin(thinness)) {
        mark(mesh, "point" in anchor ? { sort: "point", kind: "point", name: anchor.point } : { sort: "line", kind: "bar", name });
        this.updates.push((t) => this.put(mesh, this.motion.anchorAt(anchor, t)));
      }
    }
  }

  /** In a plane a pin in an eye, in space a ball. */
  private pin(thinness: number): Mesh[] {
    const radius = RADIUS.pin * this.scale * thinness;
    if (!this.motion.planar) return [this.solid(new SphereGeometry(radius, 24, 16), (colours) => colours.joint)];
    const across = new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), this.motion.across);
    const disc = (share: number, length: number): BufferGeometry => new CylinderGeometry(share * radius, share * radius, length * radius, 28).applyQuaternion(across);
    return [this.solid(disc(1, 2.6), (colours) => colours.joint, FrontSide), this.solid(disc(0.5, 2.8), (colours) => colours.pin, FrontSide)];
  }

  private addGuide(from: Anchor, to: Anchor): void {
    const geometry = new BufferGeometry().setFromPoints([new Vector3(), new Vector3()]);
    const material = new LineBasicMaterial({ transparent: true, opacity: 0.7 });
    const line = new Line(geometry, material);
    line.frustumCulled = false;
    this.group.add(line);
    this.paints.push((colours) => material.color.set(colours.soft));
    this.updates.push((t) => {
      const ends = this.ends(from, to, t);
      line.visible = ends !== undefined;
      if (ends) geometry.setFromPoints(ends);
    });
  }

  /** Balls, larger with mass; what is fixed is drawn by `addGround`. */
  private addPoints(): void {
    const heaviest = Math.max(...this.scene.points.map((point) => point.mass), 0);
    for (const { name, kind, mass } of this.scene.points) {
      if (kind === "fixed") continue;
      const share = heaviest > 0 && mass > 0 ? Math.max(Math.cbrt(mass / heaviest), 0.6) : 0.55;
      const ball = new SphereGeometry(RADIUS.point * this.scale * share * this.thinnessAt({ point: name }), 28, 20);
      const colour = kind === "driven" ? "driven" : undefined;
      const mesh = this.solid(ball, (colours) => this.runColour?.() ?? (colour ? colours[colour] : curveColor(0)));
      mark(mesh, { sort: "point", kind: "point", name });
      this.updates.push((t) => this.put(mesh, this.motion.at(name, t)));
    }
  }

  /** Cubes where something is held: fixed points and the fixed ends of what carries load. */
  private addGround(): void {
    const cube = (at: Anchor): Mesh => {
      const edge = RADIUS.ground * this.size * this.thinnessAt(at);
      return this.solid(new BoxGeometry(edge, edge, edge), (colours) => colours.ground, FrontSide);
    };
    for (const { name, kind } of this.scene.points) {
      if (kind !== "fixed") continue;
      const mesh = cube({ point: name });
      mark(mesh, { sort: "point", kind: "fixed point", name });
      this.updates.push((t) => this.put(mesh, this.motion.at(name, t)));
    }
    const held = this.scene.lines.filter((line) => line.kind !== "guide").flatMap((line) => [line.from, line.to]);
    const places = new Map(held.flatMap((end) => ("fixed" in end ? [[end.fixed.join(), end.fixed] as const] : [])));
    for (const place of places.values()) this.put(cube({ fixed: place }), place);
  }

  /** Of a line between places: at most 1. */
  private thinness(ends: [Anchor, Anchor]): number {
    const places = this.ends(...ends, this.motion.run.times[0] ?? 0);
    const tied = ends.map((end) => ("body" in end ? (this.extents.get(end.body.body) ?? 0) : 0));
    const lengths = [places ? places[0].distanceTo(places[1]) : 0, ...tied];
    return Math.max(Math.min(1, ...lengths.filter((length) => length > 0).map((length) => length / (ORDINARY * this.size))), LEAST);
  }

  /** Of the thinnest line that ends at a place. */
  private thinnessAt(place: Anchor): number {
    return this.thinnest.get(JSON.stringify(place)) ?? 1;
  }

  private addBodies(): Bodies {
    const bodies = new Bodies(this.motion, this.size, this.runColour);
    this.group.add(bodies.group);
    this.updates.push((t) => bodies.update(t));
    this.paints.push((colours) => bodies.paint(colours));
    return bodies;
  }

  private addTrails(): void {
    const free = this.scene.points.filter((point) => point.kind === "free");
    const every = Math.ceil(free.length / MOST_TRAILS);
    for (const { name } of free.filter((_, i) => i % every === 0)) this.addTrail((t) => this.motion.at(name, t), () => curveColor(0));
    if (free.length + this.scene.bodies.length > MOST_TRAILS) return;
    this.scene.bodies.forEach(({ name }, i) => {
      const trail = this.addTrail((t) => this.motion.poseAt(name, t)?.place.toArray(), () => bodyColor(i));
      this.trails.set(name, trail);
    });
  }

  private addTrail(at: (t: number) => Vec3 | undefined, colour: () => string): Trail {
    const trail = new Trail(at, this.motion.run.times[0] ?? 0, this.motion.trail);
    this.group.add(trail.object);
    this.updates.push((t) => trail.update(t));
    this.paints.push((colours) => trail.setColours(new Color(this.runColour?.() ?? colour()), new Color(colours.page)));
    return trail;
  }

  private solid(geometry: BufferGeometry, colour: (colours: Theme) => string, side: Side = this.side): Mesh {
    const mesh = new Mesh(geometry, this.material(colour, side));
    this.group.add(mesh);
    return mesh;
  }

  private material(colour: (colours: Theme) => string, side: Side = this.side): MeshStandardMaterial {
    const material = new MeshStandardMaterial({ roughness: 0.55, metalness: 0.05, side });
    this.paints.push((colours) => material.color.set(colour(colours)));
    return material;
  }

  private put(mesh: Mesh, place: Vec3 | undefined): void {
    mesh.visible = place !== undefined;
    if (place) mesh.position.set(...place);
  }

  private ends(from: Anchor, to: Anchor, t: number): [Vector3, Vector3] | undefined {
    const start = this.motion.anchorAt(from, t);
    const end = this.motion.anchorAt(to, t);
    return start && end && [new Vector3(...start), new Vector3(...end)];
  }
}
