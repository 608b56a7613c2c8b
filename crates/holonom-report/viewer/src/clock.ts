// The time that everything on the page shows.

import { Listeners } from "./listeners";

/** A moment that plots mark: when an event of a run happened. */
export interface Moment {
  /** s */
  t: number;
  run: number;
  name: string;
}

export class Clock {
  /** Simulated seconds per second of playing. */
  speed: number;
  private now: number;
  private running = false;
  private lastFrame = 0;
  private readonly timeListeners = new Listeners<[t: number]>();
  private readonly stateListeners = new Listeners<[playing: boolean]>();

  constructor(readonly start: number, readonly end: number, readonly moments: Moment[] = []) {
    this.now = start;
    this.speed = comfortableSpeed(end - start);
  }

  get time(): number {
    return this.now;
  }

  get playing(): boolean {
    return this.running;
  }

  onTime(act: (t: number) => void, place?: Node): void {
    this.timeListeners.add(act, place);
  }

  onPlaying(listener: (playing: boolean) => void): void {
    this.stateListeners.add(listener);
  }

  setTime(t: number): void {
    this.now = Math.min(Math.max(t, this.start), this.end);
    this.timeListeners.call(this.now);
  }

  play(): void {
    if (this.running || this.end <= this.start) return;
    if (this.now >= this.end) this.setTime(this.start);
    this.setRunning(true);
    this.lastFrame = performance.now();
    requestAnimationFrame(this.frame);
  }

  pause(): void {
    if (this.running) this.setRunning(false);
  }

  toggle(): void {
    if (this.running) this.pause();
    else this.play();
  }

  private setRunning(running: boolean): void {
    this.running = running;
    this.stateListeners.call(running);
  }

  private readonly frame = (moment: number): void => {
    if (!this.running) return;
    // The first frame may carry a moment from before `play`.
    const elapsed = Math.max(moment - this.lastFrame, 0) / 1000;
    this.lastFrame = moment;
    this.setTime(this.now + elapsed * this.speed);
    if (this.now >= this.end) this.pause();
    else requestAnimationFrame(this.frame);
  };
}

/** Real time where that takes between 2 s and a minute, else a round factor that takes about ten seconds. */
function comfortableSpeed(duration: number): number {
  if (!(duration > 0) || (duration >= 2 && duration <= 60)) return 1;
  return 10 ** Math.round(Math.log10(duration / 10));
}
