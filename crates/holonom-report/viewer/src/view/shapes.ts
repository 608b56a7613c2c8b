// Solids between two places.

import { BufferGeometry, Curve, CylinderGeometry, Object3D, TubeGeometry, Vector3 } from "three";

const UP = new Vector3(0, 1, 0);
const direction = new Vector3();

/** Height 1 along y from the origin, to be stretched by `stretch`. */
export function stick(radius: number, sides = 20): BufferGeometry {
  return new CylinderGeometry(radius, radius, 1, sides).translate(0, 0.5, 0);
}

/** A coil spring of the given length along y from the origin, with straight ends. */
export function coil(radius: number, wire: number, length: number): BufferGeometry {
  return new TubeGeometry(new Helix(radius, length), 420, wire, 8);
}

/** Puts a solid of length `natural` along y between two places; false when they coincide. */
export function stretch(solid: Object3D, from: Vector3, to: Vector3, natural = 1): boolean {
  direction.subVectors(to, from);
  const length = direction.length();
  solid.visible = length > 1e-12 && Number.isFinite(length);
  if (!solid.visible) return false;
  solid.position.copy(from);
  solid.quaternion.setFromUnitVectors(UP, direction.divideScalar(length));
  solid.scale.set(1, length / natural, 1);
  return true;
}

class Helix extends Curve<Vector3> {
  private static readonly turns = 9;
  /** Share of the length that is straight at either end. */
  private static readonly lead = 0.12;

  constructor(private readonly radius: number, private readonly length: number) {
    super();
  }

  override getPoint(t: number, target = new Vector3()): Vector3 {
    const lead = Helix.lead;
    const along = Math.min(Math.max((t - lead) / (1 - 2 * lead), 0), 1);
    // The radius grows from 0 and falls to 0 again over a quarter turn, where the straight ends begin.
    const quarter = 1 / (4 * Helix.turns);
    const radius = this.radius * Math.min(along / quarter, (1 - along) / quarter, 1);
    const angle = 2 * Math.PI * Helix.turns * along;
    return target.set(radius * Math.cos(angle), t * this.length, radius * Math.sin(angle));
  }
}
