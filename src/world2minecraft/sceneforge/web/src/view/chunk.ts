// One chunk on the GPU: its mesh at up to three finenesses, each with the cells' version it shows.

import * as THREE from "three";

import { CHUNK, FACES, type ChunkMesh, type Style } from "./mesher";
import type { Vec3 } from "../wire";

export type Step = 1 | 2 | 4;

export interface Built {
  mesh: THREE.Mesh | null; // null: nothing to draw
  starts: number[];
  version: number;
  style: Style;
}

export class Chunk {
  touched = false; // edited: wanted at once
  readonly built = new Map<Step, Built>();
  readonly middle: THREE.Vector3; // in cells

  constructor(
    readonly key: number,
    readonly low: Vec3,
    public version: number, // of its cells: what is of an older one is stale
  ) {
    const half = CHUNK / 2;
    this.middle = new THREE.Vector3(low[0] + half, low[1] + half, low[2] + half);
  }

  isFresh(step: Step, style: Style): boolean {
    const one = this.built.get(step);
    return one !== undefined && one.version === this.version && one.style === style;
  }

  /** What to draw where `step` is wanted: it, else a fresh finer or coarser one, else a stale one. */
  best(step: Step, style: Style): Built | null {
    const order: Step[] = step === 1 ? [1, 2, 4] : step === 2 ? [2, 1, 4] : [4, 2, 1];
    const fresh = order.find((one) => this.isFresh(one, style));
    const any = fresh ?? order.find((one) => this.built.has(one));
    return any === undefined ? null : this.built.get(any)!;
  }

  /** Draw one of the meshes and no other. */
  show(wanted: Built | null): void {
    for (const one of this.built.values()) if (one.mesh) one.mesh.visible = one === wanted;
  }

  get quads(): number {
    let sum = 0;
    for (const { starts } of this.built.values()) sum += starts[FACES]!;
    return sum;
  }

  drop(step: Step): void {
    const mesh = this.built.get(step)?.mesh;
    this.built.delete(step);
    if (!mesh) return;
    mesh.removeFromParent();
    mesh.geometry.setIndex(null); // It is shared: disposing must not delete it.
    mesh.geometry.dispose();
  }
}

/** A mesh of a chunk's quads; the index is shared by all. */
export function meshOf(
  low: Vec3,
  { words }: ChunkMesh,
  index: THREE.BufferAttribute,
  material: THREE.Material,
): THREE.Mesh {
  const geometry = new THREE.BufferGeometry();
  const bytes = new THREE.InterleavedBuffer(new Uint8Array(words.buffer), 8);
  geometry.setAttribute("place", new THREE.InterleavedBufferAttribute(bytes, 4, 0));
  geometry.setAttribute("kind", new THREE.InterleavedBufferAttribute(bytes, 4, 4));
  geometry.setIndex(index);
  const half = CHUNK / 2;
  geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(half, half, half), half * 1.74);
  const mesh = new THREE.Mesh(geometry, [material]);
  mesh.position.set(...low);
  mesh.updateMatrix();
  mesh.matrixAutoUpdate = false;
  return mesh;
}

/** Two triangles for each four vertices, the same for all. */
export function quadIndex(quads: number): THREE.BufferAttribute {
  const index = new Uint32Array(quads * 6);
  for (let quad = 0, at = 0, first = 0; quad < quads; quad++, at += 6, first += 4) {
    index[at] = index[at + 3] = first;
    index[at + 1] = first + 1;
    index[at + 2] = index[at + 4] = first + 2;
    index[at + 5] = first + 3;
  }
  return new THREE.BufferAttribute(index, 1);
}

/** Index ranges of the wanted face directions; neighbours in the buffer are drawn as one. */
export function rangesOf(wanted: readonly boolean[], starts: readonly number[]): THREE.GeometryGroup[] {
  const groups: THREE.GeometryGroup[] = [];
  for (let face = 0; face < FACES; face++) {
    const start = starts[face]! * 6;
    const count = starts[face + 1]! * 6 - start;
    if (!wanted[face] || !count) continue;
    const last = groups[groups.length - 1];
    if (last && last.start + last.count === start) last.count += count;
    else groups.push({ start, count, materialIndex: 0 });
  }
  return groups;
}
