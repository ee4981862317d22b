// Where a slice or the section box cuts through cells of one class, the mesh has no face: the cut
// is closed with the cells of its outermost layers.

import * as THREE from "three";

import { quadIndex } from "./chunk";
import type { VoxelMaterial } from "./material";
import type { Seen } from "./pick";
import { isOccupied, UNKNOWN } from "./volume";
import type { Vec3 } from "../wire";

/** Quads that close the cuts, each four corners of x y z face | label step 0 0. */
export function capQuads(labels: Uint8Array, shape: Vec3, { low, high }: Pick<Seen, "low" | "high">): Uint16Array {
  const out: number[] = [];
  if (low.some((l, i) => l >= high[i]!)) return new Uint16Array(0);
  for (let axis = 0; axis < 3; axis++) {
    if (high[axis]! < shape[axis]!) capSide(out, labels, shape, low, high, axis);
    if (low[axis]! > 0) capSide(out, labels, shape, low, high, axis + 3);
  }
  return Uint16Array.from(out);
}

function capSide(out: number[], labels: Uint8Array, shape: Vec3, low: Vec3, high: Vec3, face: number): void {
  const axis = face % 3;
  const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
  const stride = [shape[1] * shape[2], shape[2], 1];
  const layer = face < 3 ? high[axis]! - 1 : low[axis]!;
  const ahead = face < 3 ? stride[axis]! : -stride[axis]!;
  const wide = high[u]! - low[u]!;
  const mask = new Uint8Array(wide * (high[v]! - low[v]!));
  for (let b = low[v]!, i = 0; b < high[v]!; b++)
    for (let a = low[u]!; a < high[u]!; a++, i++) {
      const at = layer * stride[axis]! + a * stride[u]! + b * stride[v]!;
      const label = labels[at]!;
      // Where the labels differ the mesh has a face already.
      if (isOccupied(label) && labels[at + ahead] === label && label !== UNKNOWN) mask[i] = label;
    }
  const plane = layer + (face < 3 ? 1 : 0);
  eachRectangle(mask, wide, (a, b, across, down, label) => {
    const corner = (p: number, q: number) => {
      const at: Vec3 = [0, 0, 0];
      at[axis] = plane;
      at[u] = low[u]! + a + p * across;
      at[v] = low[v]! + b + q * down;
      out.push(...at, face | (p << (3 + u)) | (q << (3 + v)), label, 1, 0, 0);
    };
    corner(0, 0);
    if (face < 3) corner(1, 0);
    else corner(0, 1);
    corner(1, 1);
    if (face < 3) corner(0, 1);
    else corner(1, 0);
  });
}

/** Cover the cells of a mask, row by row, with rectangles of equal labels. The mask is used up. */
function eachRectangle(
  mask: Uint8Array,
  wide: number,
  call: (a: number, b: number, across: number, down: number, label: number) => void,
): void {
  const rows = mask.length / wide;
  for (let b = 0; b < rows; b++)
    for (let a = 0; a < wide; a++) {
      const label = mask[b * wide + a]!;
      if (!label) continue;
      let across = 1;
      while (a + across < wide && mask[b * wide + a + across] === label) across += 1;
      let down = 1;
      const same = (row: number) => {
        for (let i = 0; i < across; i++) if (mask[row * wide + a + i] !== label) return false;
        return true;
      };
      while (b + down < rows && same(b + down)) down += 1;
      for (let row = b; row < b + down; row++) mask.fill(0, row * wide + a, row * wide + a + across);
      call(a, b, across, down, label);
      a += across - 1;
    }
}

export class Caps {
  private mesh: THREE.Mesh | null = null;
  private of = "";

  constructor(
    private readonly group: THREE.Group,
    private readonly material: VoxelMaterial,
  ) {}

  /** Cells changed: the caps are other ones. */
  forget(): void {
    this.of = "";
  }

  take(labels: Uint8Array, shape: Vec3, seen: Seen, shown: boolean): void {
    const wanted = [...seen.low, ...seen.high, shown].join();
    if (wanted === this.of) return;
    this.of = wanted;
    this.mesh?.removeFromParent();
    this.mesh?.geometry.dispose();
    this.mesh = null;
    const words = shown ? capQuads(labels, shape, seen) : new Uint16Array(0);
    if (!words.length) return;
    const geometry = new THREE.BufferGeometry();
    const buffer = new THREE.InterleavedBuffer(words, 8);
    geometry.setAttribute("place", new THREE.InterleavedBufferAttribute(buffer, 4, 0));
    geometry.setAttribute("kind", new THREE.InterleavedBufferAttribute(buffer, 4, 4));
    geometry.setIndex(quadIndex(words.length / 32));
    this.mesh = new THREE.Mesh(geometry, this.material.greedy);
    this.mesh.frustumCulled = false;
    this.mesh.matrixAutoUpdate = false;
    this.group.add(this.mesh);
    this.mesh.updateMatrixWorld(true);
  }
}
