// A rod that slides in a barrel, with an eye at either end: a driven distance, a damper.

import { Group, Mesh, SphereGeometry, type Material, type Vector3 } from "three";
import { stick, stretch } from "./shapes";

/** Radii as shares of the size of the picture, and at most of the shortest length. */
const [BARREL, ROD, MOST_OF_LENGTH] = [0.0105, 0.0048, 0.09];
/** Of the shortest length, what the barrel takes. */
const SHARE = 0.85;

export class Cylinder {
  readonly group = new Group();
  private readonly barrel: Mesh;
  private readonly rod: Mesh;
  private readonly eyes: Mesh[];
  private readonly length: number;

  /** `shortest`: that its ends come to each other in the run, m. */
  constructor(shortest: number, size: number, barrel: Material, rod: Material) {
    this.length = SHARE * shortest;
    const thick = Math.min(size, (MOST_OF_LENGTH / BARREL) * shortest);
    this.barrel = new Mesh(stick(BARREL * thick, 28), barrel);
    this.rod = new Mesh(stick(ROD * thick, 20), rod);
    const eye = new SphereGeometry(1.15 * BARREL * thick, 24, 16);
    this.eyes = [new Mesh(eye, barrel), new Mesh(eye, rod)];
    this.group.add(this.barrel, this.rod, ...this.eyes);
  }

  /** False where it has no length. */
  put(from: Vector3, to: Vector3): boolean {
    const distance = from.distanceTo(to);
    const towards = to.clone().sub(from).divideScalar(distance);
    const mouth = from.clone().addScaledVector(towards, Math.min(this.length, distance));
    this.eyes[0].position.copy(from);
    this.eyes[1].position.copy(to);
    return stretch(this.barrel, from, mouth) && stretch(this.rod, from.clone().addScaledVector(towards, 0.1 * this.length), to);
  }
}
