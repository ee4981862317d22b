// One chunk of cells becomes quads: a face wherever the neighbour's label differs, so that hiding
// a class needs no new mesh, joined greedily where labels are equal. No three.js in here: workers
// and tests import it.
//
// A vertex is two uint32: x | y << 8 | z << 16 | face << 24 | corner << 27, label | step << 8.
// x y z count cells from the chunk's low corner; corner has a bit for each axis on whose high side
// of the quad, or in cubes of the cell x y z, the vertex lies. Faces are ordered so that the three that a
// camera can see are mostly neighbours in the buffer.

import { UNKNOWN } from "./volume";
import type { Vec3 } from "../wire";

export const CHUNK = 32;
export const FACES = 6; // +x +y +z -x -y -z
const PAD = CHUNK + 2;
const STRIDE: Vec3 = [PAD * PAD, PAD, 1];
const QUAD = 8; // uint32 a quad

export interface ChunkMesh {
  words: Uint32Array; // two a vertex, four vertices a quad
  starts: number[]; // [7] first quad of each face direction, and the end
}

export type Style = "greedy" | "cubes";

let out = new Uint32Array(1 << 16);
let used = 0;
const padded = new Uint8Array(PAD * PAD * PAD);
const mask = new Uint8Array(CHUNK * CHUNK);

/**
 * Mesh the chunk whose low corner is cell `low` of a volume.
 *
 * `step` 2 or 4 meshes blocks of that many cells a side, closed at the chunk's own sides so that a
 * finer neighbour leaves no gap. "cubes" gives all six faces of each cell that shows one.
 */
export function meshChunk(
  labels: Uint8Array,
  shape: Vec3,
  low: Vec3,
  step = 1,
  style: Style = "greedy",
): ChunkMesh {
  used = 0;
  const side = CHUNK / step;
  const some = step === 1 ? copyPadded(labels, shape, low) : copyCoarse(labels, shape, low, step);
  if (!some) return { words: new Uint32Array(0), starts: [0, 0, 0, 0, 0, 0, 0] };
  const starts: number[] = [];
  const cubes = style === "cubes" ? shownCells(side) : null;
  for (let face = 0; face < FACES; face++) {
    starts.push(used / QUAD);
    if (cubes) emitCubes(cubes, face);
    else greedyFace(face, side, step);
  }
  starts.push(used / QUAD);
  return { words: out.slice(0, used), starts };
}

/** Copy the chunk with one cell around it; unknown and outside are empty. False: nothing in it. */
function copyPadded(labels: Uint8Array, [X, Y, Z]: Vec3, [x0, y0, z0]: Vec3): boolean {
  padded.fill(0);
  let some = 0;
  const zFrom = Math.max(z0 - 1, 0);
  const zTo = Math.min(z0 + CHUNK + 1, Z);
  for (let x = Math.max(x0 - 1, 0); x < Math.min(x0 + CHUNK + 1, X); x++) {
    for (let y = Math.max(y0 - 1, 0); y < Math.min(y0 + CHUNK + 1, Y); y++) {
      const from = (x * Y + y) * Z;
      const to = (x - x0 + 1) * STRIDE[0] + (y - y0 + 1) * PAD - z0 + 1;
      for (let z = zFrom; z < zTo; z++) {
        const label = labels[from + z]!;
        if (label === UNKNOWN) continue;
        padded[to + z] = label;
        some |= label;
      }
    }
  }
  return some !== 0;
}

/** As copyPadded for blocks: the label that most of a block's occupied cells have, else empty. */
function copyCoarse(labels: Uint8Array, shape: Vec3, low: Vec3, step: number): boolean {
  padded.fill(0);
  const votes = new Uint16Array(256);
  const side = CHUNK / step;
  let some = false;
  for (let x = 0; x < side; x++)
    for (let y = 0; y < side; y++)
      for (let z = 0; z < side; z++) {
        const block: Vec3 = [low[0] + x * step, low[1] + y * step, low[2] + z * step];
        const label = mostOf(labels, shape, block, step, votes);
        if (!label) continue;
        padded[(x + 1) * STRIDE[0] + (y + 1) * PAD + z + 1] = label;
        some = true;
      }
  return some;
}

function mostOf(
  labels: Uint8Array,
  [X, Y, Z]: Vec3,
  [x0, y0, z0]: Vec3,
  step: number,
  votes: Uint16Array,
): number {
  votes.fill(0, 0, 16);
  let best = 0;
  for (let x = x0; x < Math.min(x0 + step, X); x++)
    for (let y = y0; y < Math.min(y0 + step, Y); y++) {
      const row = (x * Y + y) * Z;
      for (let z = z0; z < Math.min(z0 + step, Z); z++) {
        const label = labels[row + z]!;
        if (label === 0 || label === UNKNOWN) continue;
        votes[label]! += 1;
        if (best === 0 || votes[label]! > votes[best]!) best = label;
      }
    }
  return best;
}

function greedyFace(face: number, side: number, step: number): void {
  const axis = face % 3;
  const u = (axis + 1) % 3;
  const v = (axis + 2) % 3;
  const ahead = face < 3 ? STRIDE[axis]! : -STRIDE[axis]!;
  for (let layer = 0; layer < side; layer++) {
    if (!fillMask(layer, axis, u, v, ahead, side)) continue;
    const plane = layer + (face < 3 ? 1 : 0);
    for (let b = 0; b < side; b++) {
      for (let a = 0; a < side; ) {
        const label = mask[b * CHUNK + a]!;
        if (!label) {
          a += 1;
          continue;
        }
        const wide = widthAt(a, b, label, side);
        const high = heightAt(a, b, wide, label, side);
        for (let row = b; row < b + high; row++) {
          mask.fill(0, row * CHUNK + a, row * CHUNK + a + wide);
        }
        emitQuad(face, plane, u, v, a, b, wide, high, label, step);
        a += wide;
      }
    }
  }
}

/** Labels of the cells of a layer that show a face. False: none. */
function fillMask(
  layer: number,
  axis: number,
  u: number,
  v: number,
  ahead: number,
  side: number,
): boolean {
  let some = 0;
  const base = (layer + 1) * STRIDE[axis]! + STRIDE[u]! + STRIDE[v]!;
  for (let b = 0; b < side; b++) {
    let at = base + b * STRIDE[v]!;
    for (let a = 0; a < side; a++, at += STRIDE[u]!) {
      const label = padded[at]!;
      const shown = label !== padded[at + ahead]! ? label : 0;
      mask[b * CHUNK + a] = shown;
      some |= shown;
    }
  }
  return some !== 0;
}

function widthAt(a: number, b: number, label: number, side: number): number {
  let wide = 1;
  while (a + wide < side && mask[b * CHUNK + a + wide] === label) wide += 1;
  return wide;
}

function heightAt(a: number, b: number, wide: number, label: number, side: number): number {
  let high = 1;
  for (; b + high < side; high++) {
    const row = (b + high) * CHUNK + a;
    for (let i = 0; i < wide; i++) if (mask[row + i] !== label) return high;
  }
  return high;
}

const SHIFT: Vec3 = [0, 8, 16];

function emitQuad(
  face: number,
  plane: number,
  u: number,
  v: number,
  a: number,
  b: number,
  wide: number,
  high: number,
  label: number,
  step: number,
): void {
  reserve(QUAD);
  const kind = label | (step << 8);
  const fixed = ((plane * step) << SHIFT[face % 3]!) | (face << 24);
  const a0 = (a * step) << SHIFT[u]!;
  const a1 = ((a + wide) * step) << SHIFT[u]!;
  const b0 = (b * step) << SHIFT[v]!;
  const b1 = ((b + high) * step) << SHIFT[v]!;
  const [onU, onV] = [1 << (27 + u), 1 << (27 + v)];
  const second = face < 3 ? a1 | b0 | onU : a0 | b1 | onV;
  const fourth = face < 3 ? a0 | b1 | onV : a1 | b0 | onU;
  out[used] = fixed | a0 | b0;
  out[used + 2] = fixed | second;
  out[used + 4] = fixed | a1 | b1 | onU | onV;
  out[used + 6] = fixed | fourth;
  for (let i = 1; i < QUAD; i += 2) out[used + i] = kind;
  used += QUAD;
}

/** Padded places of the cells with at least one face between two labels. */
function shownCells(side: number): Uint32Array {
  const found: number[] = [];
  for (let x = 1; x <= side; x++)
    for (let y = 1; y <= side; y++)
      for (let z = 1; z <= side; z++) {
        const at = x * STRIDE[0] + y * PAD + z;
        const label = padded[at]!;
        if (label && STRIDE.some((s) => padded[at + s] !== label || padded[at - s] !== label)) {
          found.push(at);
        }
      }
  return Uint32Array.from(found);
}

function emitCubes(cells: Uint32Array, face: number): void {
  const axis = face % 3;
  const fixed = face < 3 ? 1 << axis : 0;
  const u = 1 << ((axis + 1) % 3);
  const v = 1 << ((axis + 2) % 3);
  const corners = face < 3 ? [0, u, u | v, v] : [0, v, u | v, u];
  for (const at of cells) {
    reserve(QUAD);
    const z = (at % PAD) - 1;
    const y = (Math.floor(at / PAD) % PAD) - 1;
    const x = Math.floor(at / STRIDE[0]) - 1;
    for (const corner of corners) {
      out[used++] = x | (y << 8) | (z << 16) | (face << 24) | ((corner | fixed) << 27);
      out[used++] = padded[at]! | (1 << 8);
    }
  }
}

function reserve(words: number): void {
  if (used + words <= out.length) return;
  const larger = new Uint32Array(out.length * 2);
  larger.set(out);
  out = larger;
}
