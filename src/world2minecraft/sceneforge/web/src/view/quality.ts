// How finely frames are drawn while something moves, so that moving stays smooth on software GL
// too; what stands still is always drawn in full.

export interface Fineness {
  scale: number; // of the canvas's pixels
  coarse: number; // 0..3: how early far chunks are drawn in larger blocks
}

const LEVELS: readonly Fineness[] = [
  { scale: 2, coarse: 0 }, // More pixels than the screen has: edges are smooth without multisampling.
  { scale: 1.5, coarse: 0 },
  { scale: 1, coarse: 0 },
  { scale: 0.8, coarse: 0 },
  { scale: 0.65, coarse: 1 },
  { scale: 0.5, coarse: 2 },
  { scale: 0.4, coarse: 3 },
];
const FIRST = 2;
const SLOW_MS = 42; // Over 20 frames a second with something to spare.
const FAST_MS = 20;
const PATIENCE = 10; // Fast frames before a finer level is tried.

export class Quality {
  private level = FIRST;
  private fast = 0;

  get moving(): Fineness {
    return LEVELS[this.level]!;
  }

  /** What stands still may take its time, but not for ever. */
  get still(): Fineness {
    const scale = this.level === 0 ? 2 : this.level < LEVELS.length - 2 ? 1.5 : 1;
    return { scale, coarse: 0 };
  }

  /** A frame while moving took so long, from its start to the next one's. */
  took(ms: number): void {
    if (ms > SLOW_MS) {
      this.fast = 0;
      const far = ms > 2.5 * SLOW_MS ? 2 : 1;
      this.level = Math.min(this.level + far, LEVELS.length - 1);
    } else if (ms < FAST_MS && ++this.fast >= PATIENCE) {
      this.fast = 0;
      this.level = Math.max(this.level - 1, 0);
    }
  }
}

const ENOUGH_PX = [1.1, 2.5, 6, 12]; // by `coarse`: a cell of fewer pixels is drawn in a block

/** Cells a side, 1, 2 or 4, that a chunk is drawn in whose cells are so many pixels large. */
export function stepFor(pixels: number, coarse: number): 1 | 2 | 4 {
  const enough = ENOUGH_PX[coarse] ?? ENOUGH_PX[0]!;
  return pixels >= enough ? 1 : pixels >= enough / 2 ? 2 : 4;
}
