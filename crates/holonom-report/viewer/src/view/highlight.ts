// Lights up what is selected.

import { Color, Mesh, MeshStandardMaterial, type Object3D } from "three";
import { same, type Item } from "../selection";
import { theme } from "../theme";
import { itemOf } from "./pick";

export class Highlight {
  private readonly lit = new Map<Mesh, MeshStandardMaterial>();

  constructor(private readonly roots: Object3D[]) {}

  show(item: Item | undefined): void {
    this.clear();
    if (!item) return;
    const light = new Color(theme().lit);
    for (const root of this.roots) {
      root.traverse((object) => {
        if (!(object instanceof Mesh && object.material instanceof MeshStandardMaterial && same(itemOf(object), item))) return;
        this.lit.set(object, object.material);
        object.material = object.material.clone();
        object.material.emissive = light;
      });
    }
  }

  /** Gives back the materials that are shared; they must not change while something is lit. */
  clear(): void {
    for (const [mesh, material] of this.lit) {
      (mesh.material as MeshStandardMaterial).dispose();
      mesh.material = material;
    }
    this.lit.clear();
  }
}
