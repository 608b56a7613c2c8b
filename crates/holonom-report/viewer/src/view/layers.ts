// Bodies that are joined must not lie in each other: neighbours get different layers, as in a linkage made of sheet metal.

import { Vector3 } from "three";
import { type Motion } from "../motion";
import type { Scene } from "../payload";
import { jointAxes } from "./side";

/** Name of a body → 0, 1, 2, …: the smallest number that no neighbour has. */
export function layers(scene: Scene): Map<string, number> {
  const neighbours = new Map<string, Set<string>>(scene.bodies.map(({ name }) => [name, new Set()]));
  for (const { body, other } of scene.joints) {
    if (!body || !other) continue;
    neighbours.get(body)?.add(other);
    neighbours.get(other)?.add(body);
  }
  const found = new Map<string, number>();
  for (const { name } of scene.bodies) {
    const taken = new Set([...(neighbours.get(name) ?? [])].map((other) => found.get(other)));
    let layer = 0;
    while (taken.has(layer)) layer++;
    found.set(name, layer);
  }
  return found;
}

/** Name of a body → the direction, in its axes, that all its revolute joints have in common. */
export function commonAxes(motion: Motion): Map<string, Vector3> {
  const found = new Map<string, Vector3 | undefined>();
  for (const joint of motion.run.scene.joints) {
    if (joint.kind !== "revolute") continue;
    for (const { body, axis } of jointAxes(motion, joint)) {
      const known = found.get(body);
      const agrees = !found.has(body) || (known !== undefined && Math.abs(known.dot(axis)) > 0.9999);
      found.set(body, agrees ? (known ?? axis) : undefined);
    }
  }
  return new Map([...found].flatMap(([body, axis]) => (axis ? [[body, axis] as const] : [])));
}
