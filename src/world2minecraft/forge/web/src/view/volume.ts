// Cells of a scene in memory: flat C-order numbers, runs, and the binary block of /api/volume.

import type { HeldRun, Run, Vec3 } from "../wire";

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

/** Write what cells hold now, as a change of the document or a preview names them. */
export function applyHeld(
  into: { labels: Uint8Array; instance?: Uint16Array; confidence?: Uint8Array },
  cells: readonly HeldRun[],
): void {
  for (const [first, length, label, instance, confidence] of cells) {
    const end = first + length;
    into.labels.fill(label, first, end);
    into.instance?.fill(instance, first, end);
    into.confidence?.fill(confidence, first, end);
  }
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

export function* cellsOfRuns(runs: readonly Run[]): Generator<number> {
  for (const [first, length] of runs) {
    for (let flat = first; flat < first + length; flat++) yield flat;
  }
}

export interface Block {
  shape: Vec3;
  voxel_m: number;
  origin_m: Vec3;
  data: Uint8Array | Uint16Array;
}

const MAGIC = 0x564d3257; // "W2MV", little-endian
const HEADER = 40;

/** Read the block that /api/volume sends. Throws where it is no such block. */
export function readBlock(buffer: ArrayBuffer): Block {
  const view = new DataView(buffer);
  if (buffer.byteLength < HEADER || view.getUint32(0, true) !== MAGIC) {
    throw new Error("not a W2MV block");
  }
  const version = view.getUint16(4, true);
  if (version !== 1) throw new Error(`W2MV version ${version}, this page reads 1`);
  const three = (at: number, read: (at: number, little: boolean) => number): Vec3 => [
    read.call(view, at, true),
    read.call(view, at + 4, true),
    read.call(view, at + 8, true),
  ];
  const data = view.getUint8(6) === 1 ? new Uint16Array(buffer, HEADER) : new Uint8Array(buffer, HEADER);
  const shape = three(8, view.getUint32);
  const cells = shape[0] * shape[1] * shape[2];
  if (cells === 0 || data.length % cells) throw new Error("a W2MV block with a part missing");
  return { shape, voxel_m: view.getFloat32(20, true), origin_m: three(24, view.getFloat32), data };
}
