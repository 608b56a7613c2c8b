// What is selected in the picture: its columns are plotted, and its forces are drawn.

import { Listeners } from "./listeners";
import type { Scene } from "./payload";

/** Something in the picture that has a name. */
export interface Item {
  sort: "body" | "point" | "joint" | "line" | "drive";
  /** In words, as "revolute joint". */
  kind: string;
  name: string;
}

export class Selection {
  private chosen: Item | undefined;
  private readonly listeners = new Listeners();

  get item(): Item | undefined {
    return this.chosen;
  }

  select(item: Item | undefined): void {
    if (same(item, this.chosen)) return;
    this.chosen = item;
    this.listeners.call();
  }

  onChange(listener: () => void): void {
    this.listeners.add(listener);
  }
}

export function same(a: Item | undefined, b: Item | undefined): boolean {
  return a?.name === b?.name && a?.sort === b?.sort;
}

/** Whose columns tell of an item: its own, and of a joint those of its drives. */
export function ownersOf(item: Item, scenes: Scene[]): string[] {
  const joints = item.sort === "joint" ? scenes.flatMap((scene) => scene.joints) : [];
  const joint = joints.find((joint) => joint.name === item.name);
  return [item.name, ...(joint?.drives ?? [])];
}
