// Cells as flat C-order numbers and as runs: (x * Y + y) * Z + z.

import type { Run, Vec3 } from "../wire";

export const UNSEEN = 255;

export function flatOf(cell: Vec3, shape: Vec3): number {
  return (cell[0] * shape[1] + cell[1]) * shape[2] + cell[2];
}

export function cellOf(flat: number, shape: Vec3): Vec3 {
  const z = flat % shape[2];
  const rest = (flat - z) / shape[2];
  const y = rest % shape[1];
  return [(rest - y) / shape[1], y, z];
}

export function isInside(cell: Vec3, shape: Vec3): boolean {
  return cell.every((at, axis) => at >= 0 && at < shape[axis as 0]);
}

/** Runs, sorted and apart, that name the cells; each cell may be named more than once. */
export function runsOf(flats: Iterable<number>): Run[] {
  const sorted = Int32Array.from(flats).sort();
  const runs: Run[] = [];
  let last: Run | null = null;
  for (const flat of sorted) {
    if (last && flat < last[0] + last[1]) continue;
    if (last && flat === last[0] + last[1]) last[1] += 1;
    else runs.push((last = [flat, 1]));
  }
  return runs;
}

export function cellsOfRuns(runs: readonly (readonly number[])[]): number[] {
  const flats: number[] = [];
  for (const [first = 0, length = 0] of runs) {
    for (let at = 0; at < length; at++) flats.push(first + at);
  }
  return flats;
}

export type Shape = "sphere" | "cube" | "single";

/** The cells of a brush of a diameter around a cell, cut at the grid's faces. */
export function stamp(at: Vec3, shape: Vec3, brush: Shape, size: number): number[] {
  const wide = brush === "single" ? 1 : Math.max(1, Math.round(size));
  const low = at.map((value) => value - Math.floor((wide - 1) / 2)) as Vec3;
  const middle = low.map((value) => value + (wide - 1) / 2) as Vec3;
  const reach = (wide / 2) ** 2;
  const flats: number[] = [];
  for (let x = low[0]; x < low[0] + wide; x++) {
    for (let y = low[1]; y < low[1] + wide; y++) {
      for (let z = low[2]; z < low[2] + wide; z++) {
        const far = (x - middle[0]) ** 2 + (y - middle[1]) ** 2 + (z - middle[2]) ** 2;
        if (brush === "sphere" && far > reach) continue;
        if (isInside([x, y, z], shape)) flats.push(flatOf([x, y, z], shape));
      }
    }
  }
  return flats;
}

/** The cells between two, one for each step along the longest axis; both ends are in it. */
export function line(from: Vec3, to: Vec3): Vec3[] {
  const steps = Math.max(...from.map((value, axis) => Math.abs(to[axis as 0] - value)), 1);
  return Array.from({ length: steps + 1 }, (_, at) => {
    const share = at / steps;
    return from.map((value, axis) => Math.round(value + (to[axis as 0] - value) * share)) as Vec3;
  });
}

/** All cells of the same label that hold to one by faces; about the first `most` of them. */
export function component(start: number, labels: Uint8Array, shape: Vec3, most = Infinity): number[] {
  const label = labels[start];
  const seen = new Uint8Array(labels.length);
  const found = [start];
  seen[start] = 1;
  const strides = [shape[1] * shape[2], shape[2], 1];
  for (let at = 0; at < found.length && found.length < most; at++) {
    const flat = found[at] ?? 0;
    const cell = cellOf(flat, shape);
    for (let axis = 0; axis < 3; axis++) {
      for (const step of [-1, 1]) {
        const there = (cell[axis] ?? 0) + step;
        if (there < 0 || there >= (shape[axis] ?? 0)) continue;
        const next = flat + step * (strides[axis] ?? 0);
        if (seen[next] || labels[next] !== label) continue;
        seen[next] = 1;
        found.push(next);
      }
    }
  }
  return found;
}

/** The lowest and highest corner of cells, both in the box; null for none. */
export function boundsOf(flats: Iterable<number>, shape: Vec3): { low: Vec3; high: Vec3 } | null {
  const low: Vec3 = [Infinity, Infinity, Infinity];
  const high: Vec3 = [-1, -1, -1];
  for (const flat of flats) {
    cellOf(flat, shape).forEach((at, axis) => {
      low[axis as 0] = Math.min(low[axis as 0], at);
      high[axis as 0] = Math.max(high[axis as 0], at);
    });
  }
  return high[0] < 0 ? null : { low, high };
}
