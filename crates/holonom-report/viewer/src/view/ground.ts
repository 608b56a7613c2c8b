// How high the ground lies that is drawn below a mechanism in space.

import { Vector3 } from "three";
import type { Motion } from "../motion";
import { boundingBox, diagonal, isTied } from "./frame";

/** How far below the lowest place the ground lies where nothing stands on it, over the size of the picture: as far as joints stand above their feet. */
const BELOW = 0.04;
/** Joints whose side in the world is a plane. */
const PLANES = new Set(["planar", "point-on-plane"]);

/** Along `up`: of the planes that things move and roll on, or where what weight alone holds is lowest, or else below everything. */
export function groundLevel(motions: Motion[], up: Vector3): number {
  const box = boundingBox(motions);
  const [lowest, size] = [box.min.dot(up), diagonal(box)];
  const levels = motions.flatMap(({ run }) => run.scene.joints).flatMap(({ kind, body, at, axis, radius }) => {
    if (body !== null || !axis) return [];
    const height = new Vector3(...at).dot(up);
    const sine = new Vector3(...axis).normalize().cross(up).length();
    // What a disc touches lies below its middle.
    if (radius !== undefined) return [height - radius * sine];
    return PLANES.has(kind) && sine < 1e-6 ? [height] : [];
  });
  if (levels.length > 0) return Math.min(...levels);
  const isHeld = motions.some((motion) => isTied(motion) || new Vector3(...motion.run.scene.gravity).dot(up) >= 0);
  return isHeld ? lowest - BELOW * size : lowest;
}
