// Wheels that couplers tie: what they look like, and where the straight parts of a belt are.

import { BoxGeometry, BufferGeometry, TorusGeometry, Vector3 } from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";
import { carried, type Motion } from "../motion";
import type { Wheels } from "../payload";
import { poseOf, sidesOf, type Side } from "./side";

/** Thickness of a ring around the z axis, and length and width of a tooth on it, in units. */
const [RING, LONG, WIDE] = [0.3, 1.3, 0.5];
/** Teeth are as many as leave so many units between them, within these bounds: a picture of teeth, not their count. */
const [APART, FEWEST, MOST] = [2.2, 8, 60];

/** Around z, of a radius in units: the rim of a wheel, with teeth for a gear. */
export function wheel(radius: number, hasTeeth: boolean): BufferGeometry {
  const count = hasTeeth ? Math.min(Math.max(Math.round((2 * Math.PI * radius) / APART), FEWEST), MOST) : 0;
  const tooth = (k: number): BufferGeometry => new BoxGeometry(LONG, WIDE, 2 * RING).translate(radius, 0, 0).rotateZ((2 * Math.PI * k) / count);
  return mergeGeometries([new TorusGeometry(radius, RING, 10, 72), ...Array.from({ length: count }, (_, k) => tooth(k))]);
}

/** A wheel with spokes, which shows how a disc rolls that has no shape. */
export function disc(radius: number): BufferGeometry {
  const spoke = (angle: number): BufferGeometry => new BoxGeometry(2 * radius, WIDE, RING).rotateZ(angle);
  return mergeGeometries([wheel(radius, false), ...[0, 1, 2].map((k) => spoke((k * Math.PI) / 3))]);
}

/** Where the wheels sit on what they are parts of; nothing where that has no motion. */
export function sidesOfWheels(motion: Motion, { joints, bodies }: Wheels): (Side | undefined)[] {
  return joints.map((name, k) => {
    const joint = motion.run.scene.joints.find((joint) => joint.name === name);
    return joint && sidesOf(motion, joint)?.find(({ body }) => body === bodies[k]);
  });
}

/** The ends of both straight parts of a belt at time t. */
export function straightParts(motion: Motion, { kind, radii }: Wheels, sides: Side[], t: number): [Vector3, Vector3][] {
  const poses = sides.map(({ body }) => (body === null ? poseOf(motion, null, 0) : motion.poseAt(body, t)));
  const [first, second] = poses.map((pose, k) => pose && carried(pose, sides[k].at.toArray()));
  const [r1, r2] = [radii[0] ?? 0, kind === "belt" ? (radii[1] ?? 0) : -(radii[1] ?? 0)];
  if (!first || !second || !poses[0]) return [];
  const axis = sides[0].axis.clone().applyQuaternion(poses[0].turn);
  const way = second.clone().sub(first);
  way.addScaledVector(axis, -way.dot(axis));
  const sine = (r1 - r2) / way.length();
  if (!(Math.abs(sine) < 1)) return [];
  way.normalize();
  const aside = new Vector3().crossVectors(axis, way);
  return [1, -1].map((half) => {
    // From the middle of each wheel to where the belt leaves it.
    const arm = way.clone().multiplyScalar(sine).addScaledVector(aside, half * Math.sqrt(1 - sine * sine));
    return [first.clone().addScaledVector(arm, r1), second.clone().addScaledVector(arm, r2)];
  });
}
