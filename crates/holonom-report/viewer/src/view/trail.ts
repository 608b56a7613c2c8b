// The path that a point or the centre of a body has come, fading into the past.

import { Color } from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import type { Vec3 } from "../payload";

const SEGMENTS = 180;

export class Trail {
  readonly object: LineSegments2;
  isHidden = false;
  private readonly geometry = new LineSegmentsGeometry();
  private readonly places = new Float32Array(6 * SEGMENTS);

  /** `first`: when the run starts; `window`: how far back the trail goes, s. */
  constructor(private readonly at: (t: number) => Vec3 | undefined, private readonly first: number, private readonly window: number) {
    this.geometry.setPositions(this.places);
    this.geometry.setColors(new Float32Array(6 * SEGMENTS));
    this.object = new LineSegments2(this.geometry, new LineMaterial({ linewidth: 2.2, vertexColors: true, depthWrite: false }));
    // Drawn before all solids, which then cover it.
    this.object.renderOrder = -1;
    this.object.frustumCulled = false;
  }

  /** Fades from the colour of the point to that of the page. */
  setColours(point: Color, page: Color): void {
    const colours = new Float32Array(6 * SEGMENTS);
    const mixed = new Color();
    for (let end = 0; end < 2 * SEGMENTS; end++) {
      const age = Math.ceil(end / 2) / SEGMENTS; // 0 now, 1 long ago
      mixed.lerpColors(page, point, 0.95 * (1 - age) ** 0.9).toArray(colours, 3 * end);
    }
    this.geometry.setColors(colours);
  }

  update(t: number): void {
    const { first } = this;
    let near = this.at(t);
    let segments = 0;
    for (let i = 1; i <= SEGMENTS; i++) {
      const past = t - (this.window * i) / SEGMENTS;
      const far = this.at(Math.max(past, first));
      if (!near || !far) break;
      this.places.set([...near, ...far], 6 * segments++);
      near = far;
      if (past <= first) break;
    }
    this.geometry.instanceCount = segments;
    this.geometry.getAttribute("instanceStart").needsUpdate = true;
    this.object.visible = segments > 0 && !this.isHidden;
  }
}
