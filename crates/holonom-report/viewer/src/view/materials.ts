// Surfaces of bodies and joints of one run, shared by everything of the same colour.

import { Color, LineBasicMaterial, MeshStandardMaterial, type Material } from "three";
import { bodyColor, type Theme } from "../theme";
import type { Part } from "./symbols";

/** As many as there are colours of bodies. */
const COLOURS = 8;
/** How far surfaces are pushed back for the lines on them, in the smallest steps of depth. */
const OFFSET = 4;

export class Materials {
  readonly centre = new MeshStandardMaterial({ roughness: 0.5, vertexColors: true });
  private readonly surfaces = range(COLOURS, () => surface(0.5));
  private readonly glasses = range(COLOURS, glass);
  private readonly edges = range(COLOURS, () => new LineBasicMaterial({ transparent: true, opacity: 0.85 }));
  private readonly parts: Record<Exclude<Part, "body">, MeshStandardMaterial> = {
    joint: surface(0.4),
    pin: surface(0.35),
    ground: surface(0.8),
    pane: surface(0.8),
    drive: surface(0.45),
  };

  /** `runColour`: of all bodies, when several runs are compared. */
  constructor(private readonly runColour: (() => string) | undefined) {
    Object.assign(this.parts.pane, { transparent: true, opacity: 0.25, depthWrite: false });
  }

  surface(body: number): Material {
    return this.surfaces[body % COLOURS];
  }

  /** The surface of a body that one sees through. */
  glass(body: number): Material {
    return this.glasses[body % COLOURS];
  }

  edge(body: number): Material {
    return this.edges[body % COLOURS];
  }

  /** `body`: the one that the part is on; none: the world. */
  part(part: Part, body: number | undefined): Material {
    if (part !== "body") return this.parts[part];
    return body === undefined ? this.parts.ground : this.surface(body);
  }

  paint(colours: Theme): void {
    for (let i = 0; i < COLOURS; i++) {
      const colour = new Color(this.runColour?.() ?? bodyColor(i));
      this.surfaces[i].color.copy(colour);
      this.glasses[i].color.copy(colour);
      this.edges[i].color.copy(colour).multiplyScalar(0.42);
    }
    this.parts.joint.color.set(colours.joint);
    this.parts.pin.color.set(colours.pin);
    this.parts.ground.color.set(colours.ground);
    this.parts.drive.color.set(colours.driven);
    this.parts.pane.color.set(colours.soft);
  }

  /** Whether one sees through the bodies: then another run can be seen that is in the same place. */
  setGhost(ghost: boolean): void {
    for (const material of this.surfaces) {
      const wasGhost = material.transparent;
      // Behind a solid in the same place.
      Object.assign(material, { transparent: ghost, opacity: ghost ? 0.3 : 1, depthWrite: !ghost });
      material.polygonOffsetUnits = ghost ? 500 * OFFSET : OFFSET;
      material.needsUpdate = wasGhost !== ghost;
    }
  }
}

function glass(): MeshStandardMaterial {
  return new MeshStandardMaterial({ roughness: 0.5, transparent: true, opacity: 0.22, depthWrite: false });
}

/** Pushed back a little, so that the lines on it are seen whole. */
function surface(roughness: number): MeshStandardMaterial {
  return new MeshStandardMaterial({ roughness, metalness: 0.05, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: OFFSET });
}

function range<T>(count: number, make: () => T): T[] {
  return Array.from({ length: count }, make);
}
