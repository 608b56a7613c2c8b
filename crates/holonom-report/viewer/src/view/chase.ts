// A mechanism that nothing ties to the ground and that goes far beyond its own size, as a vehicle does: the picture goes with it.

import { Box3, Vector3 } from "three";
import type { Motion } from "../motion";
import { boundingBox, boxAt, diagonal, isTied } from "./frame";

/** The way is at least so many times the size of the mechanism. */
const TRAVELS = 8;
/** Room around the mechanism, over its size. */
const ROOM = 0.15;

export class Chase {
  private readonly start: Vector3;

  private constructor(
    private readonly motion: Motion,
    /** Where the mechanism is at the start. */
    readonly box: Box3,
  ) {
    this.start = this.centre(motion.run.times[0] ?? 0);
  }

  /** Of the first of some motions; nothing where all of the way is a better picture, as that of what falls or has no size. */
  static of(motions: Motion[], up: Vector3): Chase | undefined {
    const box = boxAt(motions, 0);
    const size = diagonal(box);
    const way = boundingBox(motions);
    const rises = motions[0].planar ? 0 : Math.abs(way.getSize(new Vector3()).dot(up));
    const isChased = !motions.some(isTied) && size > 0 && diagonal(way) > TRAVELS * size && rises < TRAVELS * size;
    return isChased ? new Chase(motions[0], box.expandByScalar(ROOM * size)) : undefined;
  }

  /** How far the mechanism has come at time t. */
  at(t: number): Vector3 {
    return this.centre(t).sub(this.start);
  }

  /** The middle of its bodies, or of its points where it has none. */
  private centre(t: number): Vector3 {
    const { bodies, points } = this.motion.run.scene;
    const ofBodies = bodies.flatMap(({ name }) => this.motion.poseAt(name, t)?.place ?? []);
    const ofPoints = points.map(({ name }) => this.motion.at(name, t)).flatMap((place) => (place ? [new Vector3(...place)] : []));
    const places = ofBodies.length > 0 ? ofBodies : ofPoints;
    const sum = places.reduce((sum, place) => sum.add(place), new Vector3());
    return places.length > 0 ? sum.divideScalar(places.length) : sum;
  }
}
