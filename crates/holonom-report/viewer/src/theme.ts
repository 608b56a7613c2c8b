// Colours, light and dark.

const dark = matchMedia("(prefers-color-scheme: dark)");

/** Okabe and Ito's palette, which the colour-blind can tell apart, in an order of falling contrast; lighter on dark. */
const LIGHT = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#b8860b", "#56b4e9", "#5c6672"];
const DARK = ["#4aa8e0", "#ff8a3d", "#2fc79a", "#e79cc6", "#f0c040", "#a5d8f8", "#98a2ae"];

export function curveColor(index: number): string {
  const palette = dark.matches ? DARK : LIGHT;
  return palette[index % palette.length];
}

/** When the palette is used up, the same colours come again dashed. */
export function curveDash(index: number): number[] | undefined {
  const lap = Math.floor(index / LIGHT.length);
  return lap === 0 ? undefined : [6 / lap, 3];
}

export interface Theme {
  page: string;
  ink: string;
  soft: string;
  line: string;
  bar: string;
  rod: string;
  spring: string;
  ground: string;
  driven: string;
}

export function theme(): Theme {
  return dark.matches
    ? { page: "#181c21", ink: "#e6e9ed", soft: "#98a2ae", line: "#313840", bar: "#8d9aa8", rod: "#a7b1bc", spring: "#2fc79a", ground: "#7b8794", driven: "#ff8a3d" }
    : { page: "#fafbfc", ink: "#1b1f24", soft: "#5c6672", line: "#d9dee4", bar: "#75828f", rod: "#8a96a3", spring: "#009e73", ground: "#4b5561", driven: "#d55e00" };
}

export function onThemeChange(listener: () => void): void {
  dark.addEventListener("change", listener);
}
