// What holds a joint in the world: in a plane the sign for the ground, in space a pedestal, or a bearing block around a level axis.

import { BoxGeometry, BufferGeometry, CylinderGeometry, Group, Matrix4, Mesh, Vector3, type Material } from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";
import type { Motion } from "../motion";
import { plate } from "./plate";
import { poseOf, type Side } from "./side";
import type { Pen } from "./sketch";

/** From the joint to the ground, in units of the pen. */
const HEIGHT = 3.8;

/** Geometries in units of the pen: joint at the origin, ground at −y, its axis along z. */
const SIGN = ((): BufferGeometry => {
  const house = [new Vector3(), new Vector3(-1.7, -2.9, 0), new Vector3(1.7, -2.9, 0)];
  return mergeGeometries([plate(house, new Vector3(0, 0, 1), 0.9, 0.3), hatch(-HEIGHT - 0.2, 3.6, 6).toNonIndexed()]);
})();
const CONE = new CylinderGeometry(0.9, 2.1, HEIGHT - 0.5, 28).translate(0, -(HEIGHT - 0.5) / 2, 0);
const CHEEK = plate([new Vector3(0, 0, 0), new Vector3(-1.2, -HEIGHT + 1.4, 0), new Vector3(1.2, -HEIGHT + 1.4, 0)], new Vector3(0, 0, 1), 1.3, 0.6);
const BASE = new BoxGeometry(6.2, 0.6, 1).translate(0, -HEIGHT, 0);

/** A line, and strokes below it. */
function hatch(level: number, half: number, strokes: number): BufferGeometry {
  const line = new BoxGeometry(2 * half, 0.4, 0.3).translate(0, level, 0);
  const pitch = (2 * half) / strokes;
  const stroke = (i: number): BufferGeometry =>
    new BoxGeometry(0.22, 1.6, 0.3).rotateZ(-Math.PI / 4).translate(-half + (i + 0.35) * pitch, level - 0.65, 0);
  return mergeGeometries([line, ...Array.from({ length: strokes }, (_, i) => stroke(i))]);
}

/** `side`: of the joint, in the world; `hub`: length of what turns in it, m; nothing for other kinds. */
export function foot(motion: Motion, side: Side, body: string | null, hub: number | undefined, pen: Pen, material: Material): Group {
  const group = new Group();
  const up = footUp(motion, side.at, body, pen.unit);
  const axis = motion.planar ? motion.across : side.axis;
  const level = Math.abs(axis.dot(up)) < 0.8;
  const aside = new Vector3().crossVectors(up, level ? axis : Math.abs(up.x) < 0.8 ? new Vector3(1, 0, 0) : new Vector3(0, 1, 0)).normalize();
  group.setRotationFromMatrix(new Matrix4().makeBasis(aside, up, new Vector3().crossVectors(aside, up)));
  group.scale.setScalar(pen.unit);
  group.position.copy(side.at);
  const add = (geometry: BufferGeometry, z = 0): Mesh => {
    const mesh = new Mesh(geometry, material);
    mesh.position.z = z;
    group.add(mesh);
    return mesh;
  };
  if (motion.planar) {
    add(SIGN);
    group.position.addScaledVector(motion.across, -5 * pen.thickness);
    return group;
  }
  const half = (hub ?? 0) / (2 * pen.unit);
  if (hub !== undefined && level) {
    for (const end of [-1, 1]) add(CHEEK, end * (half - 0.3));
    add(BASE).scale.z = 2 * half + 0.8;
    return group;
  }
  add(CONE);
  add(BASE).scale.z = 6.2;
  // A hub that stands on the ground stands on the pedestal.
  group.position.addScaledVector(up, -Math.max(half - 0.3, 0) * pen.unit);
  return group;
}

/** Away from the ground: against gravity, but what hangs in its joint, at least so far below it, hangs from a ceiling. */
function footUp(motion: Motion, place: Vector3, body: string | null, least: number): Vector3 {
  const up = motion.planar ? new Vector3(0, 1, 0).applyQuaternion(motion.plane) : new Vector3(0, 0, 1);
  const gravity = new Vector3(...motion.run.scene.gravity);
  if (motion.planar) gravity.addScaledVector(motion.across, -gravity.dot(motion.across));
  if (gravity.length() > 0) up.copy(gravity).normalize().negate();
  const rows = motion.run.times.length;
  const step = Math.max(1, Math.floor(rows / 100));
  let [height, seen] = [0, 0];
  for (let row = 0; row < rows && body !== null; row += step) {
    const pose = poseOf(motion, body, row);
    if (!pose) continue;
    const towards = pose.place.clone().sub(place);
    height += towards.length() > least ? towards.normalize().dot(up) : 0;
    seen++;
  }
  return height < -0.3 * seen ? up.negate() : up;
}
