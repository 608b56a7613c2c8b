// Colours, light and dark.

import { Listeners } from "./listeners";

const dark = matchMedia("(prefers-color-scheme: dark)");
const listeners = new Listeners();
dark.addEventListener("change", () => listeners.call());

/**
 * After Okabe and Ito, moved apart until the nearest two are 20 units of CIELAB apart to the eye and to every kind of colour-blindness
 * (28 on dark), in an order of falling contrast.
 */
const LIGHT = ["#0072b2", "#ba4300", "#00a646", "#a46c8c", "#e5a11d", "#43bcff", "#283409"];
const DARK = ["#656fff", "#e08302", "#04ac65", "#b178c8", "#ffe61f", "#7defff", "#ddffd7"];

/** When the palette is used up, the same colours come again in these patterns, px. */
const DASHES = [[7, 3], [2, 2.5], [9, 3, 2, 3], [4, 2]];

export function curveColor(index: number): string {
  const palette = dark.matches ? DARK : LIGHT;
  return palette[index % palette.length];
}

export function curveDash(index: number): number[] | undefined {
  const lap = Math.floor(index / LIGHT.length);
  return lap === 0 ? undefined : DASHES[(lap - 1) % DASHES.length];
}

/** Bodies are large: calmer than curves, and apart from each other. */
const LIGHT_BODIES = ["#4f83b8", "#d08a4e", "#5aa382", "#a8748f", "#c9ab45", "#58a3b5", "#c46f66", "#8087b5"];
const DARK_BODIES = ["#5e93cb", "#d6935a", "#5fae8b", "#b4819d", "#cfb350", "#5fadbf", "#cd7b72", "#8d94c4"];

export function bodyColor(index: number): string {
  const palette = dark.matches ? DARK_BODIES : LIGHT_BODIES;
  return palette[index % palette.length];
}

export interface Theme {
  page: string;
  ink: string;
  soft: string;
  line: string;
  bar: string;
  rod: string;
  spring: string;
  rope: string;
  ground: string;
  driven: string;
  /** Hubs, balls and sleeves. */
  joint: string;
  /** What turns or slides in them. */
  pin: string;
  /** Arrows. */
  force: string;
  moment: string;
  /** Glow of what is selected. */
  lit: string;
}

export function theme(): Theme {
  return dark.matches
    ? { page: "#181c21", ink: "#e6e9ed", soft: "#98a2ae", line: "#313840", bar: "#8d9aa8", rod: "#a7b1bc", spring: "#2fc79a", rope: "#d8b16c", ground: "#7b8794",
        driven: "#ff8a3d", joint: "#4a545f", pin: "#dfe5eb", force: "#ff6b8f", moment: "#c9a2ff", lit: "#5a4a10" }
    : { page: "#fafbfc", ink: "#1b1f24", soft: "#5c6672", line: "#d9dee4", bar: "#75828f", rod: "#8a96a3", spring: "#009e73", rope: "#8a6420", ground: "#4b5561",
        driven: "#d55e00", joint: "#3d4650", pin: "#eef1f4", force: "#c2185b", moment: "#6a35b0", lit: "#6b5200" };
}

export function onThemeChange(listener: () => void, place?: Node): void {
  listeners.add(listener, place);
}
