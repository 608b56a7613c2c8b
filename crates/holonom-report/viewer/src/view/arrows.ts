// Forces as arrows and moments as bent ones, with what they are at the moment beside their tips.

import { ConeGeometry, Group, Mesh, MeshBasicMaterial, TorusGeometry, Vector3 } from "three";
import { element } from "../dom";
import { reading } from "../format";
import type { Motion } from "../motion";
import { theme } from "../theme";
import type { Acting } from "./acting";
import type { Camera } from "./camera";
import { stick } from "./shapes";

/** The longest arrow, the radius of the largest bent one, and the radius of their shafts, as shares of the size of the picture. */
const [LENGTH, BEND, SHAFT] = [0.2, 0.065, 0.0035];
/** Rows that are looked at for the largest. */
const SAMPLES = 300;
/** More are a tangle. */
const [MOST_ARROWS, MOST_LABELS] = [60, 12];
/** A moment that is so small beside the forces, times the size of the picture, is rounding. */
const ROUNDING = 1e-9;
/** Least distance of labels, px. */
const APART = 17;
/** Of the circle that a bent arrow goes around. */
const ARC = 1.5 * Math.PI;

const UP = new Vector3(0, 1, 0);
const Z = new Vector3(0, 0, 1);

interface Arrow {
  acting: Acting;
  group: Group;
  label: HTMLElement | undefined;
  /** Tip in the world. */
  tip: Vector3;
}

export class Arrows {
  readonly group = new Group();
  readonly labels = element("div", { class: "forces", "aria-live": "off" });
  private arrows: Arrow[] = [];
  private readonly most = { N: 0, "N·m": 0 };
  private readonly materials = { N: overlay(), "N·m": overlay() };

  constructor(private readonly size: number) {}

  show(motion: Motion | undefined, acting: Acting[]): void {
    for (const { group } of this.arrows) this.group.remove(group);
    this.labels.replaceChildren();
    this.arrows = [];
    if (!motion) return;
    const { times } = motion.run;
    const step = Math.max(1, Math.floor(times.length / SAMPLES));
    const largest = acting.map(({ vector }) => {
      let most = 0;
      for (let row = 0; row < times.length; row += step) most = Math.max(most, finite(vector(times[row])?.length()));
      return most;
    });
    this.most.N = Math.max(0, ...largest.filter((_, i) => acting[i].unit === "N"));
    this.most["N·m"] = Math.max(0, ...largest.filter((_, i) => acting[i].unit === "N·m"));
    const least = { N: 0, "N·m": ROUNDING * this.most.N * this.size };
    const seen = acting.filter(({ unit }, i) => largest[i] > Math.max(least[unit], ROUNDING * this.most[unit])).slice(0, MOST_ARROWS);
    this.arrows = seen.map((acting, i) => {
      const label = i < MOST_LABELS ? element("div") : undefined;
      if (label) this.labels.append(label);
      const group = acting.unit === "N" ? this.straight() : this.bent();
      this.group.add(group);
      return { acting, group, label, tip: new Vector3() };
    });
  }

  paint(): void {
    this.materials.N.color.set(theme().force);
    this.materials["N·m"].color.set(theme().moment);
    this.labels.style.setProperty("--force", theme().force);
    this.labels.style.setProperty("--moment", theme().moment);
  }

  update(t: number): void {
    for (const { acting, group, label, tip } of this.arrows) {
      const [at, vector] = [acting.at(t), acting.vector(t)];
      const amount = finite(vector?.length());
      const share = amount / this.most[acting.unit];
      group.visible = at !== undefined && vector !== undefined && share > 1e-6;
      if (label) {
        label.hidden = !group.visible;
        label.className = acting.unit === "N" ? "" : "moment";
        label.replaceChildren(acting.name, element("b", {}, ` ${reading(amount)} ${acting.unit}`));
      }
      if (!group.visible || !at || !vector) continue;
      group.position.copy(at);
      vector.divideScalar(amount);
      if (acting.unit === "N") this.point(group, vector, share * LENGTH * this.size, tip);
      else this.bend(group, vector, Math.max(share, 0.3) * BEND * this.size, tip);
    }
  }

  /** Puts the labels beside the tips, below each other where they would meet. */
  place(camera: Camera, width: number, height: number): void {
    const taken: [number, number][] = [];
    for (const { group, label, tip } of this.arrows) {
      if (!label || label.hidden) continue;
      const [seen, tail] = [tip.clone().project(camera), group.position.clone().project(camera)];
      const aside = seen.x < tail.x - 0.01 ? -6 - label.offsetWidth : 6;
      const x = Math.min(Math.max(((seen.x + 1) / 2) * width + aside, 4), width - label.offsetWidth - 4);
      let y = Math.min(Math.max(((1 - seen.y) / 2) * height - 8, 4), height - 20);
      while (taken.some(([u, v]) => Math.abs(v - y) < APART && Math.abs(u - x) < 110)) y += APART;
      taken.push([x, y]);
      label.style.transform = `translate(${x}px, ${y}px)`;
    }
  }

  /** A copy of the picture with the labels in it. */
  drawnOn(picture: HTMLCanvasElement): HTMLCanvasElement {
    const canvas = element("canvas", { width: String(picture.width), height: String(picture.height) });
    const pen = canvas.getContext("2d")!;
    pen.drawImage(picture, 0, 0);
    const bounds = picture.getBoundingClientRect();
    pen.scale(picture.width / bounds.width, picture.height / bounds.height);
    pen.font = "600 12px system-ui, sans-serif";
    for (const { label, acting } of this.arrows) {
      if (!label || label.hidden) continue;
      const { left, bottom } = label.getBoundingClientRect();
      pen.fillStyle = acting.unit === "N" ? theme().force : theme().moment;
      pen.fillText(label.textContent ?? "", left - bounds.left + 5, bottom - bounds.top - 5);
    }
    return canvas;
  }

  private straight(): Group {
    const radius = SHAFT * this.size;
    const shaft = new Mesh(stick(radius, 12), this.materials.N);
    const head = new Mesh(new ConeGeometry(3.2 * radius, 9 * radius, 20).translate(0, -4.5 * radius, 0), this.materials.N);
    return overall(shaft, head);
  }

  private point(group: Group, direction: Vector3, length: number, tip: Vector3): void {
    const [shaft, head] = group.children;
    const headLength = Math.min(9 * SHAFT * this.size, 0.6 * length);
    const thin = headLength / (9 * SHAFT * this.size);
    group.quaternion.setFromUnitVectors(UP, direction);
    shaft.scale.set(Math.max(thin, 0.5), length - 0.9 * headLength, Math.max(thin, 0.5));
    head.position.y = length;
    head.scale.setScalar(thin);
    tip.copy(group.position).addScaledVector(direction, length);
  }

  /** Of radius 1 around z, by the right hand. */
  private bent(): Group {
    const arc = new Mesh(new TorusGeometry(1, 0.06, 10, 48, ARC), this.materials["N·m"]);
    const head = new Mesh(new ConeGeometry(0.2, 0.5, 20), this.materials["N·m"]);
    head.position.set(Math.cos(ARC), Math.sin(ARC), 0);
    head.rotation.z = ARC;
    return overall(arc, head);
  }

  private bend(group: Group, axis: Vector3, radius: number, tip: Vector3): void {
    group.quaternion.setFromUnitVectors(Z, axis);
    group.scale.setScalar(radius);
    tip.set(1, 0, 0).applyQuaternion(group.quaternion).multiplyScalar(radius).add(group.position);
  }
}

/** Seen through everything. */
function overlay(): MeshBasicMaterial {
  return new MeshBasicMaterial({ depthTest: false, transparent: true, opacity: 0.9 });
}

function overall(...parts: Mesh[]): Group {
  for (const part of parts) part.renderOrder = 10;
  return new Group().add(...parts);
}

function finite(value: number | undefined): number {
  return value !== undefined && Number.isFinite(value) ? value : 0;
}
