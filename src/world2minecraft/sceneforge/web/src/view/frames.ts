// When frames are drawn: only when something changed, coarsely while things move, in full once
// they stand still.

import type { Fineness, Quality } from "./quality";

const REST_MS = 160; // without a change, until all is drawn in full

const AFTER = 3; // frames that may still wait for what an unusual one has begun

export interface Painted {
  again: boolean; // the next frame shows something else: a flight goes on
  settled: boolean; // nothing is missing in it
  more: boolean; // at rest, another pass makes it finer
  usual: boolean; // it did no more than frames do: no shader was compiled, no mesh made
}

export class Frames {
  lastMs = 0; // of a frame while moving, to the next one's start
  private asked = 0;
  private timer = 0;
  private wanted = false;
  private began = 0;
  private unusual = 1; // how many frames more tell nothing about speed
  private waiting: (() => void)[] = [];

  constructor(
    private readonly quality: Quality,
    private readonly paint: (fineness: Fineness, now: number, pass: number | null) => Painted,
  ) {}

  /** Something changed: draw soon. */
  invalidate(): void {
    clearTimeout(this.timer);
    this.wanted = true;
    this.ask();
  }

  /** Resolves when all is drawn in full and nothing moves. */
  idle(): Promise<void> {
    return new Promise((resolve) => {
      this.waiting.push(resolve);
      this.invalidate();
    });
  }

  dispose(): void {
    cancelAnimationFrame(this.asked);
    clearTimeout(this.timer);
  }

  /** After the next frame is on its way: a change that comes before is not kept waiting. */
  private later(call: () => void): void {
    requestAnimationFrame(() => {
      if (!this.wanted) this.timer = window.setTimeout(call, 0);
    });
  }

  private ask(): void {
    this.asked ||= requestAnimationFrame((now) => this.tick(now));
  }

  private tick(now: number): void {
    this.asked = 0;
    if (this.began) {
      if (!this.unusual) {
        this.lastMs = performance.now() - this.began;
        this.quality.took(this.lastMs);
      }
      this.began = 0;
    }
    if (this.wanted) this.draw(now);
  }

  private draw(now: number): void {
    this.wanted = false;
    this.began = performance.now();
    const { again, settled, usual } = this.paint(this.quality.moving, now, null);
    this.unusual = usual ? Math.max(this.unusual - 1, 0) : AFTER;
    this.wanted = again;
    this.ask(); // Also where nothing is to be drawn: to see when this frame was done.
    if (again || !settled) return;
    this.timer = window.setTimeout(() => this.drawFull(), this.waiting.length ? 0 : REST_MS);
  }

  private drawFull(pass = 0): void {
    if (this.wanted) return;
    this.unusual = Math.max(this.unusual, 1); // The time that is being taken has this in it.
    const { again, settled, more } = this.paint(this.quality.still, performance.now(), pass);
    if (again) this.invalidate();
    else if (settled && more) this.later(() => this.drawFull(pass + 1));
    else if (settled) for (const resolve of this.waiting.splice(0)) resolve();
    // else: invalidate() comes with the meshes that miss
  }
}
