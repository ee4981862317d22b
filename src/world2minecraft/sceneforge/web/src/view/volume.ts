// Cells of a scene in memory: flat C-order numbers and runs of them.

import type { Run, Vec3 } from "../wire";

export const UNKNOWN = 255;

export type Cell = [number, number, number];

export interface Volume {
  labels: Uint8Array;
  shape: Vec3;
}

export function flatOf(shape: Vec3, x: number, y: number, z: number): number {
  return (x * shape[1] + y) * shape[2] + z;
}

export function cellOf(shape: Vec3, flat: number): Cell {
  const z = flat % shape[2];
  const row = (flat - z) / shape[2];
  const y = row % shape[1];
  return [(row - y) / shape[1], y, z];
}

export function isOccupied(label: number): boolean {
  return label !== 0 && label !== UNKNOWN;
}

/** Flat cell numbers, in any order, as runs of neighbours. */
export function runsOf(flats: Iterable<number>): Run[] {
  const sorted = Uint32Array.from(flats).sort();
  const runs: Run[] = [];
  let last: Run | undefined;
  for (const flat of sorted) {
    if (last && flat < last[0] + last[1]) continue;
    if (last && flat === last[0] + last[1]) last[1] += 1;
    else runs.push((last = [flat, 1]));
  }
  return runs;
}

/** Flat numbers of the cells that differ; `into` is made equal. */
export function changedCells(into: Uint8Array, now: Uint8Array): number[] {
  const found: number[] = [];
  const four = now.byteOffset % 4 === 0 && into.byteOffset % 4 === 0 ? now.length >> 2 : 0;
  const [old, fresh] = [into, now].map((bytes) => new Uint32Array(bytes.buffer, four && bytes.byteOffset, four));
  const compare = (from: number, to: number) => {
    for (let flat = from; flat < to; flat++) {
      if (into[flat] === now[flat]) continue;
      found.push(flat);
      into[flat] = now[flat]!;
    }
  };
  for (let word = 0; word < four; word++) {
    if (old![word] !== fresh![word]) compare(4 * word, 4 * word + 4);
  }
  compare(4 * four, now.length);
  return found;
}
