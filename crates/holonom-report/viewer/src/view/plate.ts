// Flat links: the hull of some places in a plane with round corners, a strip for two of them, a disc for one.

import { BufferGeometry, ExtrudeGeometry, Matrix4, Shape, Vector2, Vector3 } from "three";

/** Places lie in a plane with the given unit normal; the plate has its middle there. */
export function plate(places: Vector3[], normal: Vector3, radius: number, thickness: number): BufferGeometry {
  const first = new Vector3(1, 0, 0);
  if (Math.abs(normal.x) > 0.9) first.set(0, 1, 0);
  first.addScaledVector(normal, -first.dot(normal)).normalize();
  const second = new Vector3().crossVectors(normal, first);
  const outline = rounded(hull(places.map((place) => new Vector2(place.dot(first), place.dot(second)))), radius);
  const geometry = new ExtrudeGeometry(outline, { depth: thickness, bevelEnabled: false, curveSegments: 14, steps: 1 });
  const level = places.reduce((sum, place) => sum + place.dot(normal), 0) / places.length;
  geometry.translate(0, 0, level - thickness / 2);
  return geometry.applyMatrix4(new Matrix4().makeBasis(first, second, normal));
}

/** Corners of the convex hull, counter-clockwise. */
export function hull(places: Vector2[]): Vector2[] {
  const sorted = [...places].sort((a, b) => a.x - b.x || a.y - b.y);
  const half = (order: Vector2[]): Vector2[] => {
    const chain: Vector2[] = [];
    for (const place of order) {
      while (chain.length > 1 && turnsRight(chain[chain.length - 2], chain[chain.length - 1], place)) chain.pop();
      chain.push(place);
    }
    return chain.slice(0, -1);
  };
  const corners = [...half(sorted), ...half(sorted.reverse())];
  return corners.length > 0 ? corners : places.slice(0, 1);
}

/** Straight on counts as right: it makes no corner. */
function turnsRight(a: Vector2, b: Vector2, c: Vector2): boolean {
  const cross = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  return cross <= 1e-9 * a.distanceTo(b) * a.distanceTo(c);
}

/** What lies within the radius of a convex polygon. */
function rounded(corners: Vector2[], radius: number): Shape {
  const shape = new Shape();
  const count = corners.length;
  if (count === 1) return shape.absarc(corners[0].x, corners[0].y, radius, 0, 2 * Math.PI, false) as Shape;
  for (let i = 0; i < count; i++) {
    const [before, corner, after] = [corners[(i + count - 1) % count], corners[i], corners[(i + 1) % count]];
    const arrives = Math.atan2(corner.y - before.y, corner.x - before.x) - Math.PI / 2;
    const leaves = Math.atan2(after.y - corner.y, after.x - corner.x) - Math.PI / 2;
    shape.absarc(corner.x, corner.y, radius, arrives, leaves, false);
  }
  shape.closePath();
  return shape;
}
