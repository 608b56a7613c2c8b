// One run's mechanism: points, what connects them, bodies, and trails.

import { BackSide, BoxGeometry, BufferGeometry, Color, FrontSide, Group, Line, LineBasicMaterial, Mesh, MeshStandardMaterial, SphereGeometry, Vector3, type Side } from "three";
import type { Motion } from "../motion";
import type { Anchor, LineKind, Scene, Vec3 } from "../payload";
import { bodyColor, curveColor, theme, type Theme } from "../theme";
import { Bodies } from "./bodies";
import { coil, stick, stretch } from "./shapes";
import { Trail } from "./trail";

/** More would be a tangle. */
const MOST_TRAILS = 16;

/** Radii as shares of the size of the whole picture. */
const RADIUS = { bar: 0.0095, rod: 0.0038, spring: 0.016, wire: 0.0028, rope: 0.0025, point: 0.017, ground: 0.026 };

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

  constructor(private readonly motion: Motion, private readonly size: number, index: number, runs: number) {
    this.scene = motion.run.scene;
    this.runColour = runs > 1 ? () => curveColor(index) : undefined;
    this.scale = size * (1 + (0.8 * index) / runs);
    this.side = index === 0 ? FrontSide : BackSide;
    for (const line of this.scene.lines) this.addLine(line.kind, line.from, line.to);
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

  private addLine(kind: LineKind, from: Anchor, to: Anchor): void {
    if (kind === "guide") return this.addGuide(from, to);
    const start = this.ends(from, to, this.motion.run.times[0] ?? 0);
    const natural = kind === "spring" ? Math.max(start ? start[0].distanceTo(start[1]) : 0, this.scale * 0.05) : 1;
    const geometry = kind === "spring" ? coil(RADIUS.spring * this.scale, RADIUS.wire * this.scale, natural) : stick(RADIUS[kind] * this.scale);
    const mesh = this.solid(geometry, (colours) => this.runColour?.() ?? colours[kind]);
    this.updates.push((t) => {
      const ends = this.ends(from, to, t);
      mesh.visible = ends !== undefined && stretch(mesh, ends[0], ends[1], natural);
    });
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
      const ball = new SphereGeometry(RADIUS.point * this.scale * share, 28, 20);
      const colour = kind === "driven" ? "driven" : undefined;
      const mesh = this.solid(ball, (colours) => this.runColour?.() ?? (colour ? colours[colour] : curveColor(0)));
      this.updates.push((t) => this.put(mesh, this.motion.at(name, t)));
    }
  }

  /** Cubes where something is held: fixed points and the fixed ends of what carries load. */
  private addGround(): void {
    const edge = RADIUS.ground * this.size;
    const cube = (): Mesh => this.solid(new BoxGeometry(edge, edge, edge), (colours) => colours.ground, FrontSide);
    for (const { name, kind } of this.scene.points) {
      if (kind !== "fixed") continue;
      const mesh = cube();
      this.updates.push((t) => this.put(mesh, this.motion.at(name, t)));
    }
    const held = this.scene.lines.filter((line) => line.kind !== "guide").flatMap((line) => [line.from, line.to]);
    const places = new Map(held.flatMap((end) => ("fixed" in end ? [[end.fixed.join(), end.fixed] as const] : [])));
    for (const place of places.values()) this.put(cube(), place);
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
    this.scene.bodies.forEach(({ name }, i) => this.addTrail((t) => this.motion.poseAt(name, t)?.place.toArray(), () => bodyColor(i)));
  }

  private addTrail(at: (t: number) => Vec3 | undefined, colour: () => string): void {
    const { times } = this.motion.run;
    const first = times[0] ?? 0;
    const trail = new Trail(at, first, ((times.at(-1) ?? 0) - first) / 8);
    this.group.add(trail.object);
    this.updates.push((t) => trail.update(t));
    this.paints.push((colours) => trail.setColours(new Color(this.runColour?.() ?? colour()), new Color(colours.page)));
  }

  private solid(geometry: BufferGeometry, colour: (colours: Theme) => string, side: Side = this.side): Mesh {
    const material = new MeshStandardMaterial({ roughness: 0.55, metalness: 0.05, side });
    const mesh = new Mesh(geometry, material);
    this.group.add(mesh);
    this.paints.push((colours) => material.color.set(colour(colours)));
    return mesh;
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
