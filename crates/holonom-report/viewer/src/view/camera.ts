// From where one looks: in space from above and aside, at a plane face-on.

import { Box3, OrthographicCamera, PerspectiveCamera, Sphere, Vector3 } from "three";

export interface Viewpoint {
  /** From the mechanism towards the camera. */
  towards: Vector3;
  up: Vector3;
  planar: boolean;
}

export function viewpoint(axes: string): Viewpoint {
  const z = new Vector3(0, 0, 1);
  switch (axes) {
    case "xy":
      return { towards: z, up: new Vector3(0, 1, 0), planar: true };
    case "xz":
      return { towards: new Vector3(0, -1, 0), up: z, planar: true };
    case "yz":
      return { towards: new Vector3(1, 0, 0), up: z, planar: true };
    default:
      return { towards: new Vector3(0.62, -0.72, 0.34).normalize(), up: z, planar: false };
  }
}

/** Distance over that at which corners of the box touch the edge of the picture. */
const MARGIN = 1.03;

export type Camera = PerspectiveCamera | OrthographicCamera;

export function buildCamera(view: Viewpoint): Camera {
  const camera = view.planar ? new OrthographicCamera() : new PerspectiveCamera(32);
  camera.up.copy(view.up);
  return camera;
}

/** Puts the camera so that the whole box is seen. */
export function frame(camera: Camera, view: Viewpoint, box: Box3, aspect: number): void {
  const sphere = box.getBoundingSphere(new Sphere());
  if (camera instanceof PerspectiveCamera) {
    const tanUp = Math.tan((camera.fov * Math.PI) / 360);
    const distance = distanceToFit(box, view, sphere, tanUp * aspect, tanUp);
    camera.position.copy(sphere.center).addScaledVector(view.towards, distance);
    camera.near = distance / 100;
    camera.far = distance * 20;
  } else {
    camera.position.copy(sphere.center).addScaledVector(view.towards, 4 * sphere.radius);
    camera.zoom = 1;
    camera.near = 0.01 * sphere.radius;
    camera.far = 20 * sphere.radius;
  }
  camera.lookAt(sphere.center);
}

/** Fits the lens to a canvas of the given shape. */
export function fitLens(camera: Camera, view: Viewpoint, box: Box3, aspect: number): void {
  if (camera instanceof PerspectiveCamera) {
    camera.aspect = aspect;
  } else {
    const size = box.getSize(new Vector3());
    const height = Math.abs(size.dot(view.up));
    const width = Math.abs(size.dot(new Vector3().crossVectors(view.up, view.towards)));
    const half = 0.5 * 1.18 * Math.max(height, width / aspect, 0.2 * size.length());
    Object.assign(camera, { left: -half * aspect, right: half * aspect, top: half, bottom: -half });
  }
  camera.updateProjectionMatrix();
}

/** Distance at which all corners of the box lie within the half-angles whose tangents are given, with some margin. */
function distanceToFit(box: Box3, view: Viewpoint, sphere: Sphere, tanAcross: number, tanUp: number): number {
  const right = new Vector3().crossVectors(view.up, view.towards).normalize();
  const up = new Vector3().crossVectors(view.towards, right);
  let distance = 0;
  for (let corner = 0; corner < 8; corner++) {
    const pick = (bit: number, low: number, high: number): number => ((corner >> bit) & 1 ? high : low);
    const place = new Vector3(pick(0, box.min.x, box.max.x), pick(1, box.min.y, box.max.y), pick(2, box.min.z, box.max.z));
    place.sub(sphere.center);
    const needed = Math.max(Math.abs(place.dot(right)) / tanAcross, Math.abs(place.dot(up)) / tanUp);
    distance = Math.max(distance, needed + place.dot(view.towards));
  }
  return MARGIN * Math.max(distance, 1.2 * sphere.radius);
}
