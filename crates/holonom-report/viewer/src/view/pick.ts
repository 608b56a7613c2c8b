// What of the mechanism is under the pointer: its name is shown, and a click selects it.

import { Mesh, Object3D, Raycaster, Vector2 } from "three";
import { element } from "../dom";
import type { Item, Selection } from "../selection";
import type { Camera } from "./camera";

/** Meshes in this layer can be picked. */
const LAYER = 1;
/** What is thin is found from so far away, px. */
const REACH = 5;
/** A press that moves less is a click, px. */
const CLICK = 4;
/** Distance of the name from the pointer, px. */
const DISTANCE = 14;

/** Makes an object stand for an item, with all that hangs on it so far. */
export function mark(object: Object3D, item: Item): void {
  object.userData["item"] = item;
  object.traverse((part) => part instanceof Mesh && part.layers.enable(LAYER));
}

/** The item that an object belongs to. */
export function itemOf(object: Object3D | null): Item | undefined {
  for (; object; object = object.parent) if (object.userData["item"]) return object.userData["item"] as Item;
  return undefined;
}

/** `targets`: what can be picked. */
export function listenToPointer(canvas: HTMLCanvasElement, camera: Camera, targets: Object3D[], selection: Selection): HTMLElement {
  const ray = new Raycaster();
  ray.layers.set(LAYER);
  const seenAt = (x: number, y: number): Item | undefined => {
    const { left, top, width, height } = canvas.getBoundingClientRect();
    ray.setFromCamera(new Vector2((2 * (x - left)) / width - 1, 1 - (2 * (y - top)) / height), camera);
    const hit = ray.intersectObjects(targets).find(({ object }) => isShown(object));
    return hit && itemOf(hit.object);
  };
  const near = (x: number, y: number): Item | undefined => {
    const around = [...Array(8).keys()].map((k) => (Math.PI * k) / 4);
    const places = [[x, y], ...around.map((angle) => [x + REACH * Math.cos(angle), y + REACH * Math.sin(angle)])];
    for (const [x, y] of places) {
      const item = seenAt(x, y);
      if (item) return item;
    }
    return undefined;
  };

  const name = element("div", { class: "name", hidden: "" });
  const hide = (): void => {
    name.hidden = true;
    canvas.style.cursor = "";
  };
  let waiting = false;
  canvas.addEventListener("pointermove", (event) => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      // Nobody reads while turning the picture.
      const item = event.buttons === 0 ? near(event.clientX, event.clientY) : undefined;
      if (!item) return hide();
      canvas.style.cursor = "pointer";
      name.replaceChildren(element("b", {}, item.name), ` ${item.kind}`);
      name.hidden = false;
      const { left, top, width } = canvas.getBoundingClientRect();
      const [x, y] = [event.clientX - left, event.clientY - top];
      name.style.transform = `translate(${Math.min(x + DISTANCE, width - name.offsetWidth - 4)}px, ${Math.max(y - 2 * DISTANCE, 4)}px)`;
    });
  });
  canvas.addEventListener("pointerleave", hide);
  let pressed: [number, number] = [NaN, NaN];
  canvas.addEventListener("pointerdown", ({ clientX, clientY }) => (pressed = [clientX, clientY]));
  canvas.addEventListener("pointerup", ({ clientX, clientY, button }) => {
    if (button === 0 && Math.hypot(clientX - pressed[0], clientY - pressed[1]) < CLICK) selection.select(near(clientX, clientY));
  });
  document.addEventListener("keydown", (event) => event.key === "Escape" && selection.select(undefined));
  return name;
}

function isShown(object: Object3D | null): boolean {
  for (; object; object = object.parent) if (!object.visible) return false;
  return true;
}
