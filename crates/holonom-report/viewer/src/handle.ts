// What a page offers to scripts and tests, as `window.holonom`.

import type { Clock } from "./clock";
import type { Motion } from "./motion";
import type { Vec3 } from "./payload";

interface Handle {
  ready: boolean;
  time(): number;
  setTime(t: number): void;
  /** World places of the points of the first run at the current time, m. */
  pointsAt(): Record<string, Vec3>;
  /** The same of the centres of mass of its bodies. */
  bodiesAt(): Record<string, Vec3>;
  /** Where a place in the world is seen in the window, px. */
  onScreen(place: Vec3): [number, number] | undefined;
}

declare global {
  interface Window {
    holonom: Handle;
  }
}

/** Offers the motion that the page is about first; `onScreen` counts places from the origin of the page. */
export function offer(motion: Motion | undefined, clock: Clock, onScreen: Handle["onScreen"]): void {
  const origin = motion?.run.origin ?? [0, 0, 0];
  const world = (place: Vec3 | undefined): Vec3 | undefined => place && (place.map((x, i) => x + origin[i]) as Vec3);
  window.holonom = {
    ready: true,
    time: () => clock.time,
    setTime: (t) => clock.setTime(t),
    pointsAt: () => placesOf(motion?.run.scene.points, (name) => world(motion?.at(name, clock.time))),
    bodiesAt: () => placesOf(motion?.run.scene.bodies, (name) => world(motion?.poseAt(name, clock.time)?.place.toArray())),
    onScreen: (place) => onScreen(place.map((x, i) => x - origin[i]) as Vec3),
  };
}

function placesOf(named: { name: string }[] | undefined, at: (name: string) => Vec3 | undefined): Record<string, Vec3> {
  const places = named?.flatMap(({ name }) => {
    const place = at(name);
    return place ? [[name, place] as const] : [];
  });
  return Object.fromEntries(places ?? []);
}
