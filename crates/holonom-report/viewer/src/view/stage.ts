// The picture: renderer, camera, light, ground, and the mechanisms of all runs.

import { AmbientLight, Color, DirectionalLight, HemisphereLight, Scene, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Clock } from "../clock";
import { element } from "../dom";
import type { Motion } from "../motion";
import type { Vec3 } from "../payload";
import type { Selection } from "../selection";
import { savePicture } from "../take";
import { onThemeChange, theme } from "../theme";
import type { Visibility } from "../visibility";
import { actingOn } from "./acting";
import { Arrows } from "./arrows";
import { buildCamera, fitLens, frame, viewpoint } from "./camera";
import { Chase } from "./chase";
import { RunChoice } from "./choice";
import { boundingBox, diagonal } from "./frame";
import { buildGrid } from "./grid";
import { groundLevel } from "./ground";
import { Highlight } from "./highlight";
import { buildLooks } from "./looks";
import { Mechanism } from "./mechanism";
import { listenToPointer } from "./pick";

const WITHOUT_WEBGL = "The picture in 3D needs WebGL, which this browser does not offer here. The plots below do not.";

/** From the world, counted from `Run.origin`, to the window, px; nothing without a picture. */
export type OnScreen = (place: Vec3) => [number, number] | undefined;

/** What all runs are called together, and what the arrow keys do. */
interface Words {
  all: string;
  arrows: string;
}

export function buildStage(
  container: HTMLElement,
  motions: Motion[],
  clock: Clock,
  visibility: Visibility,
  selection: Selection,
  words: Words = { all: "all runs of the legend", arrows: "step" },
): OnScreen {
  const canvas = element("canvas", { "aria-label": "The mechanism in 3D" });
  const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
  if (!gl) {
    container.append(element("p", { class: "note" }, WITHOUT_WEBGL));
    return () => undefined;
  }
  container.append(canvas);
  // The buffer is preserved so that the picture can be saved from the browser's menu.
  const renderer = new WebGLRenderer({ canvas, context: gl, antialias: true, preserveDrawingBuffer: true });
  const scene = new Scene();
  const view = viewpoint(motions[0].run.scene.axes);
  const chase = Chase.of(measured(motions), view.up);
  let box = chase?.box ?? boundingBox(measured(motions));
  const camera = buildCamera(view);
  const mechanisms = motions.map((motion, i) => new Mechanism(motion, diagonal(box), i, motions.length));
  const grid = buildGrid(view, box, groundLevel(measured(motions), view.up), new Vector3(...motions[0].run.origin));
  const arrows = new Arrows(diagonal(box));
  const groups = mechanisms.map((mechanism) => mechanism.group);
  const highlight = new Highlight(groups);
  scene.add(camera, grid.object, ...groups, arrows.group);
  container.append(hint(grid.cell, words));
  addLight(scene, camera);

  const controls = new OrbitControls(camera, canvas);
  // A part is looked at closely by pointing at it.
  controls.zoomToCursor = true;
  const render = drawOnDemand(() => {
    renderer.render(scene, camera);
    arrows.place(camera, container.clientWidth, container.clientHeight);
  });
  // How far the camera has gone with the mechanism.
  const gone = new Vector3();
  const follow = (t: number): void => {
    if (!chase) return;
    const way = chase.at(t);
    for (const place of [camera.position, controls.target]) place.add(way).sub(gone);
    gone.copy(way);
    grid.follow(way);
  };
  const home = (): void => {
    // A run that goes on has been elsewhere since.
    if (!chase) box = boundingBox(measured(motions));
    frame(camera, view, box, shape(container));
    fitLens(camera, view, box, shape(container));
    box.getCenter(controls.target);
    gone.set(0, 0, 0);
    follow(clock.time);
    controls.update();
    render();
  };
  const resize = (): void => {
    renderer.setPixelRatio(devicePixelRatio);
    renderer.setSize(container.clientWidth, container.clientHeight, false);
    fitLens(camera, view, box, shape(container));
    render();
  };
  const paint = (): void => {
    scene.background = new Color(theme().page);
    grid.object.material.color.set(theme().line);
    for (const mechanism of mechanisms) mechanism.paint();
    arrows.paint();
    highlight.show(selection.item);
    render();
  };
  const show = (t: number): void => {
    follow(t);
    for (const mechanism of mechanisms) mechanism.update(t);
    arrows.update(t);
    render();
  };
  controls.addEventListener("change", render);
  new ResizeObserver(resize).observe(container);
  onThemeChange(paint);
  clock.onTime(show);
  const choice = new RunChoice(motions.map((motion) => motion.run.label), visibility, words.all);
  const choose = (): void => {
    let alone = true;
    mechanisms.forEach((mechanism, run) => {
      mechanism.group.visible = choice.shows(run);
      mechanism.setGhost(!alone);
      if (choice.shows(run)) alone = false;
    });
    select();
  };
  /** Forces are those of the first run that is shown. */
  const select = (): void => {
    const first = mechanisms.find((mechanism) => mechanism.group.visible)?.motion;
    highlight.show(selection.item);
    arrows.show(first, first && selection.item ? actingOn(first, selection.item) : []);
    arrows.update(clock.time);
    render();
  };
  const looks = buildLooks([...new Set(motions.flatMap(({ run }) => run.scene.bodies.map(({ name }) => name)))], selection, (body, look) => {
    highlight.clear();
    for (const mechanism of mechanisms) mechanism.setLook(body, look);
    highlight.show(selection.item);
    show(clock.time);
  });
  const take = pictureButton(() => {
    renderer.render(scene, camera);
    return arrows.drawnOn(canvas);
  });
  const tools = element("div", { class: "tools" }, ...(looks ? [looks] : []), take, homeButton(home));
  container.append(choice.node, listenToPointer(canvas, camera, groups, selection), arrows.labels, tools);
  choice.onChange(choose);
  selection.onChange(select);
  choose();
  resize();
  home();
  paint();
  show(clock.time);
  return (place) => {
    const { left, top, width, height } = canvas.getBoundingClientRect();
    const seen = new Vector3(...place).project(camera);
    return [left + ((seen.x + 1) / 2) * width, top + ((1 - seen.y) / 2) * height];
  };
}

/** The motions that the picture has to have room for: runs that blew up go wherever they like. */
function measured(motions: Motion[]): Motion[] {
  const sound = motions.filter((motion) => motion.run.sound);
  return sound.length > 0 ? sound : motions;
}

/** Many changes within a frame make one drawing. */
function drawOnDemand(draw: () => void): () => void {
  let waiting = false;
  return () => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      draw();
    });
  };
}

function shape(container: HTMLElement): number {
  return container.clientWidth / Math.max(container.clientHeight, 1);
}

function pictureButton(draw: () => HTMLCanvasElement): HTMLElement {
  const button = element("button", { type: "button", class: "take", title: "save this picture" }, "PNG");
  button.addEventListener("click", () => savePicture(draw(), "picture"));
  return button;
}

function hint(cell: number, { arrows }: Words): HTMLElement {
  const keys = element("span", { class: "keys" }, `, right button to move, click to select · space bar plays, arrow keys ${arrows}`);
  return element("p", { class: "hint" }, `grid ${Number(cell.toPrecision(2))} m · drag to turn, scroll to zoom`, keys);
}

function homeButton(home: () => void): HTMLElement {
  const button = element("button", { type: "button", class: "home" }, "reset view");
  button.addEventListener("click", home);
  return button;
}

function addLight(scene: Scene, camera: ReturnType<typeof buildCamera>): void {
  scene.add(new AmbientLight(0xffffff, 0.9), new HemisphereLight(0xffffff, 0x8090a0, 1.1));
  // The key light goes with the camera, so that no side is ever dark.
  const key = new DirectionalLight(0xffffff, 1.8);
  key.position.set(-0.6, 1, 0.8);
  // Its target goes along as well: one that stays at the origin turns the light by where the mechanism is and how large it is.
  camera.add(key, key.target);
}
