// Which cell a ray meets first, by whole cells: no step length, so no ray can get stuck.

import { isOccupied, type Cell, type Volume } from "./volume";
import type { Vec3 } from "../wire";

export interface Hit {
  cell: Cell;
  flat: number;
  face: number; // 0..5: +x +y +z -x -y -z, the side that the ray came in through
  t: number; // along the ray, in lengths of its direction
}

/** Cells that may be met: classes that are drawn, and the box that the slices leave. */
export interface Seen {
  visible: ArrayLike<boolean>; // [256] by label
  low: Vec3;
  high: Vec3; // exclusive
}

/**
 * Walk the cells along a ray, both in cells, from where it enters the box `seen` allows.
 * `visit` is called for every cell in order, occupied or not; true ends the walk.
 */
export function walkRay(
  seen: Pick<Seen, "low" | "high">,
  from: Vec3,
  direction: Vec3,
  visit: (cell: Cell, face: number, t: number) => boolean,
): void {
  const entry = enterBox(seen.low, seen.high, from, direction);
  if (!entry) return;
  let { t, axis } = entry;
  const cell: Cell = [0, 0, 0];
  const next: Vec3 = [Infinity, Infinity, Infinity];
  const step: Vec3 = [1, 1, 1];
  for (let i = 0; i < 3; i++) {
    const d = direction[i]!;
    const at = from[i]! + t * d;
    cell[i] = Math.min(Math.max(Math.floor(at), seen.low[i]!), seen.high[i]! - 1);
    if (i === axis) cell[i] = d > 0 ? seen.low[i]! : seen.high[i]! - 1;
    step[i] = d > 0 ? 1 : -1;
    if (d !== 0) next[i] = (cell[i]! + (d > 0 ? 1 : 0) - from[i]!) / d;
  }
  if (axis < 0) axis = steepest(direction);
  let face = direction[axis]! > 0 ? axis + 3 : axis;
  for (;;) {
    if (visit(cell, face, t)) return;
    axis = next[0] <= next[1] ? (next[0] <= next[2] ? 0 : 2) : next[1] <= next[2] ? 1 : 2;
    t = next[axis]!;
    cell[axis]! += step[axis]!;
    if (cell[axis]! < seen.low[axis]! || cell[axis]! >= seen.high[axis]!) return;
    // From the plane's number, not by adding: errors would grow along the ray.
    next[axis] = (cell[axis]! + (step[axis]! > 0 ? 1 : 0) - from[axis]!) / direction[axis]!;
    face = step[axis]! > 0 ? axis + 3 : axis;
  }
}

function steepest(direction: Vec3): number {
  const [x, y, z] = direction.map(Math.abs) as Vec3;
  return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

/** Where a ray first is in a box, and the axis it came through, -1 from inside; null: never. */
function enterBox(
  low: Vec3,
  high: Vec3,
  from: Vec3,
  direction: Vec3,
): { t: number; axis: number } | null {
  let enter = 0;
  let leave = Infinity;
  let axis = -1;
  for (let i = 0; i < 3; i++) {
    if (high[i]! <= low[i]!) return null;
    const d = direction[i]!;
    if (d === 0) {
      if (from[i]! < low[i]! || from[i]! >= high[i]!) return null;
      continue;
    }
    const a = (low[i]! - from[i]!) / d;
    const b = (high[i]! - from[i]!) / d;
    if (Math.min(a, b) > enter) {
      enter = Math.min(a, b);
      axis = i;
    }
    leave = Math.min(leave, Math.max(a, b));
  }
  return leave < enter ? null : { t: enter, axis };
}

/** The first cell with a visible label along a ray in cells; null: none. */
export function pickCell(volume: Volume, seen: Seen, from: Vec3, direction: Vec3): Hit | null {
  const { labels, shape } = volume;
  let hit: Hit | null = null;
  walkRay(seen, from, direction, (cell, face, t) => {
    const flat = (cell[0] * shape[1] + cell[1]) * shape[2] + cell[2];
    const label = labels[flat]!;
    if (!isOccupied(label) || !seen.visible[label]) return false;
    hit = { cell: [...cell], flat, face, t };
    return true;
  });
  return hit;
}
