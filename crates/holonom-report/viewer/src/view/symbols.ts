// What joints look like, in units of `Pen.unit`, around the origin and along z. Every geometry exists once.

import { BoxGeometry, BufferGeometry, ConeGeometry, CylinderGeometry, OctahedronGeometry, SphereGeometry, TorusGeometry } from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";

/** Which material a part has; `body`: that of the body it is on. */
export type Part = "joint" | "pin" | "ground" | "pane" | "drive" | "body";

export interface Piece {
  geometry: BufferGeometry;
  part: Part;
}

const rod = (radius: number, length: number): BufferGeometry => new CylinderGeometry(radius, radius, length, 28).rotateX(Math.PI / 2);

/** Of height 1 along z, to be scaled. */
const HUB: Piece[] = [
  { geometry: rod(0.95, 1), part: "joint" },
  { geometry: rod(0.5, 1.12), part: "pin" },
];
const BALL: Piece[] = [{ geometry: new SphereGeometry(1.3, 32, 20), part: "joint" }];
const SMALL_BALL: Piece[] = [{ geometry: new SphereGeometry(0.95, 24, 16), part: "joint" }];
const CROSS: Piece[] = [
  { geometry: mergeGeometries([rod(0.5, 5), rod(0.5, 5).rotateX(Math.PI / 2)]), part: "pin" },
  { geometry: mergeGeometries([new BoxGeometry(1.5, 1.5, 1.5), ...[0, 1, 2, 3].map((k) => rod(0.85, 0.8).translate(0, 0, 2).rotateX((k * Math.PI) / 2))]), part: "joint" },
];
const RINGED_BALL: Piece[] = [...BALL, { geometry: new TorusGeometry(1.45, 0.3, 12, 36), part: "pin" }];
const SLEEVE: Piece[] = [{ geometry: new BoxGeometry(2.9, 2.9, 5), part: "body" }];
const ROUND_SLEEVE: Piece[] = [{ geometry: rod(1.5, 5), part: "body" }];
const PANE: Piece[] = [{ geometry: new BoxGeometry(11, 11, 0.25), part: "pane" }];
const MARK: Piece[] = [{ geometry: new OctahedronGeometry(1.3), part: "joint" }];

/** A ring of rubber around a pin. */
export const BUSHING: Piece[] = [
  { geometry: new TorusGeometry(1.25, 0.6, 14, 36), part: "ground" },
  { geometry: rod(0.7, 2.4), part: "pin" },
];

/** A bent arrow around the axis. */
const BEND = 1.55 * Math.PI;
const TURNS: Piece[] = [
  {
    geometry: mergeGeometries([
      new TorusGeometry(2.5, 0.32, 10, 48, BEND),
      new ConeGeometry(0.95, 1.9, 20).rotateZ(BEND).translate(2.5 * Math.cos(BEND), 2.5 * Math.sin(BEND), 0),
    ]),
    part: "drive",
  },
];
/** The housing of a motor, on the end of an axis at the origin. */
const MOTOR: Piece[] = [{ geometry: mergeGeometries([rod(1.7, 3.4).translate(0, 0, 1.9), rod(1.1, 0.8).translate(0, 0, 4)]), part: "drive" }];
/** An arrow to either side along the axis, beside it. */
const SLIDES: Piece[] = [
  {
    geometry: mergeGeometries([rod(0.32, 4.4), ...[1, -1].map((end) => new ConeGeometry(0.95, 1.9, 20).rotateX((end * Math.PI) / 2).translate(0, 0, 2.9 * end))]).translate(3, 0, 0),
    part: "drive",
  },
];

/** Around what is led along a curve, whose direction changes. */
const LED: Piece[] = [{ geometry: new TorusGeometry(1.7, 0.4, 12, 36), part: "drive" }];

/** What shows that a joint of some kind is driven; `housing`: at the end of its axis, where that is seen; `along`: on what slides. */
export function driveOf(kind: string): { around: Piece[]; housing: Piece[]; along: Piece[] } {
  switch (kind) {
    case "prismatic":
    case "point-on-line":
      return { around: SLIDES, housing: [], along: [] };
    case "point-on-curve":
      return { around: [], housing: [], along: LED };
    default:
      return { around: TURNS, housing: MOTOR, along: [] };
  }
}

/** Of the side that carries the joint. */
export function symbolOf(kind: string): Piece[] {
  switch (kind) {
    case "revolute":
    case "revolute-spherical":
      return HUB;
    case "spherical":
      return BALL;
    case "universal":
      return CROSS;
    case "constant-velocity":
      return RINGED_BALL;
    case "planar":
    case "point-on-plane":
      return PANE;
    case "generic":
      return MARK;
    default:
      return [];
  }
}

/** Of the other side: what slides on the rail or the pane of the first. */
export function sliderOf(kind: string): Piece[] {
  switch (kind) {
    case "prismatic":
      return SLEEVE;
    case "cylindrical":
    case "screw":
      return ROUND_SLEEVE;
    case "planar":
    case "point-on-plane":
    case "point-on-line":
    case "point-on-curve":
      return SMALL_BALL;
    default:
      return [];
  }
}

/** Radius of the rail along the axis, none for other kinds. */
export function railOf(kind: string): number | undefined {
  return { prismatic: 0.6, cylindrical: 0.6, screw: 0.6, "point-on-line": 0.25 }[kind];
}

/** Kinds with a rail for which either side can carry it: it is drawn in the world if one of them is. */
export const REVERSIBLE: ReadonlySet<string> = new Set(["prismatic", "cylindrical", "screw"]);

/** Kinds that are held by a foot where one side is the world. */
export const STANDS: ReadonlySet<string> = new Set(["revolute", "spherical", "universal", "constant-velocity", "fixed", "generic"]);

/** The end of a rail that is held in the world. */
export const RAIL_END: Piece[] = [{ geometry: new BoxGeometry(3, 3, 1.2), part: "ground" }];
/** Of height 1 along z, to be scaled. */
export const RAIL: Piece[] = [{ geometry: rod(1, 1), part: "pin" }];
