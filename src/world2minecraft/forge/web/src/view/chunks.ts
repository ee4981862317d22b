// The voxels of a scene as chunks on the GPU: which exist, which must be meshed again, and which
// of their faces can be seen.

import * as THREE from "three";

import type { VoxelMaterial } from "./material";
import { CHUNK, FACES, meshChunk, type ChunkMesh, type Style } from "./mesher";
import { Pool, type Job } from "./pool";
import type { Meshed } from "./worker";
import type { Vec3 } from "../wire";

interface Chunk {
  key: number;
  low: Vec3;
  version: number; // of its cells: an answer for an older one is thrown away
  ready: boolean;
  mesh: THREE.Mesh | null;
  starts: number[];
}

const SYNCHRONOUS = 12; // Chunks meshed at once; more go to the workers.

export class Chunks {
  readonly group = new THREE.Group();
  private chunks: Chunk[] = [];
  private counts: Vec3 = [0, 0, 0];
  private labels: Uint8Array = new Uint8Array(0);
  private shape: Vec3 = [0, 0, 0];
  private style: Style = "greedy";
  private index = quadIndex(4096);
  private readonly pool = new Pool((meshed) => this.receive(meshed));

  constructor(
    private readonly material: VoxelMaterial,
    private readonly changed: () => void,
  ) {
    this.group.matrixAutoUpdate = false;
  }

  /** Whether all chunks show what the cells are. */
  get settled(): boolean {
    return this.chunks.every(({ ready }) => ready);
  }

  get quads(): number {
    return this.chunks.reduce((sum, { starts }) => sum + (starts[FACES] ?? 0), 0);
  }

  get bytes(): number {
    return this.quads * 32 + this.index.array.byteLength;
  }

  /** Begin with another volume; `near`, in cells, is meshed first. */
  load(labels: Uint8Array, shape: Vec3, voxel: number, origin: Vec3, near: Vec3): void {
    this.clear();
    this.labels = labels;
    this.shape = shape;
    this.group.matrix.makeScale(voxel, voxel, voxel).setPosition(...origin);
    this.group.updateMatrixWorld(true);
    this.counts = shape.map((side) => Math.ceil(side / CHUNK)) as Vec3;
    const [nx, ny, nz] = this.counts;
    for (let key = 0; key < nx * ny * nz; key++) {
      const low: Vec3 = [
        Math.floor(key / (ny * nz)) * CHUNK,
        (Math.floor(key / nz) % ny) * CHUNK,
        (key % nz) * CHUNK,
      ];
      this.chunks.push({ key, low, version: 0, ready: false, mesh: null, starts: [] });
    }
    this.pool.setVolume(labels, shape);
    this.work(near);
  }

  /** Cells changed: mesh their chunks again, and those that touch them. */
  touch(flats: Iterable<number>, near: Vec3): void {
    for (const key of this.touchedBy(flats)) {
      const chunk = this.chunks[key]!;
      chunk.version += 1;
      chunk.ready = false;
    }
    this.pool.setVolume(this.labels, this.shape);
    this.work(near);
  }

  setStyle(style: Style, near: Vec3): void {
    if (style === this.style) return;
    this.style = style;
    for (const chunk of this.chunks) {
      chunk.version += 1;
      chunk.ready = false;
    }
    this.work(near);
  }

  /** Choose which faces of each chunk are drawn from an eye, or for parallel rays a direction. */
  aim(eye: Vec3 | null, direction: Vec3): void {
    for (const { mesh, low, starts } of this.chunks) {
      if (!mesh) continue;
      const faces = [0, 1, 2, 3, 4, 5].map((face) => {
        const axis = face % 3;
        if (!eye) return face < 3 ? direction[axis]! < 0 : direction[axis]! > 0;
        return face < 3 ? eye[axis]! > low[axis]! : eye[axis]! < low[axis]! + CHUNK;
      });
      mesh.geometry.groups = rangesOf(faces, starts);
    }
  }

  dispose(): void {
    this.clear();
    this.pool.dispose();
  }

  private clear(): void {
    for (const chunk of this.chunks) this.drop(chunk);
    this.chunks = [];
    this.pool.replace([]);
  }

  private touchedBy(flats: Iterable<number>): Set<number> {
    const [, Y, Z] = this.shape;
    const [nx, ny, nz] = this.counts;
    const found = new Set<number>();
    const add = (x: number, y: number, z: number) => {
      if (x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz) return;
      found.add((x * ny + y) * nz + z);
    };
    for (const flat of flats) {
      const z = flat % Z;
      const y = Math.floor(flat / Z) % Y;
      const x = Math.floor(flat / (Y * Z));
      const at: Vec3 = [Math.floor(x / CHUNK), Math.floor(y / CHUNK), Math.floor(z / CHUNK)];
      add(...at);
      [x, y, z].forEach((value, axis) => {
        const side = value % CHUNK === 0 ? -1 : value % CHUNK === CHUNK - 1 ? 1 : 0;
        if (side) add(...(at.map((n, i) => (i === axis ? n + side : n)) as Vec3));
      });
    }
    return found;
  }

  private work(near: Vec3): void {
    const away = ({ low }: Chunk) => Math.hypot(...low.map((l, i) => l + CHUNK / 2 - near[i]!));
    const waiting = this.chunks.filter(({ ready }) => !ready).sort((a, b) => away(a) - away(b));
    const now = waiting.splice(0, SYNCHRONOUS);
    for (const chunk of now) {
      this.show(chunk, meshChunk(this.labels, this.shape, chunk.low, 1, this.style));
    }
    const jobs = waiting.map(
      ({ key, version, low }): Job => ({ key, epoch: version, low, step: 1, style: this.style }),
    );
    this.pool.replace(jobs);
    this.changed();
  }

  private receive({ key, epoch, style, mesh }: Meshed): void {
    const chunk = this.chunks[key];
    if (!chunk || chunk.version !== epoch || chunk.ready || style !== this.style) return;
    this.show(chunk, mesh);
    this.changed();
  }

  private show(chunk: Chunk, { words, starts }: ChunkMesh): void {
    this.drop(chunk);
    chunk.ready = true;
    chunk.starts = starts;
    const quads = starts[FACES]!;
    if (!quads) return;
    this.growIndex(quads);
    const geometry = new THREE.BufferGeometry();
    const bytes = new THREE.InterleavedBuffer(new Uint8Array(words.buffer), 8);
    geometry.setAttribute("place", new THREE.InterleavedBufferAttribute(bytes, 4, 0));
    geometry.setAttribute("kind", new THREE.InterleavedBufferAttribute(bytes, 4, 4));
    geometry.setIndex(this.index);
    const half = CHUNK / 2;
    geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(half, half, half), half * 1.74);
    const material = this.style === "cubes" ? this.material.cubes : this.material.greedy;
    chunk.mesh = new THREE.Mesh(geometry, [material]);
    chunk.mesh.position.set(...chunk.low);
    chunk.mesh.updateMatrix();
    chunk.mesh.matrixAutoUpdate = false;
    this.group.add(chunk.mesh);
    chunk.mesh.updateMatrixWorld(true);
  }

  private drop(chunk: Chunk): void {
    if (!chunk.mesh) return;
    this.group.remove(chunk.mesh);
    chunk.mesh.geometry.setIndex(null); // It is shared: disposing must not delete it.
    chunk.mesh.geometry.dispose();
    chunk.mesh = null;
  }

  private growIndex(quads: number): void {
    if (this.index.count >= quads * 6) return;
    this.index = quadIndex(Math.max(quads, this.index.count / 3));
    for (const { mesh } of this.chunks) mesh?.geometry.setIndex(this.index);
  }
}

/** Two triangles for each four vertices, the same for all chunks. */
export function quadIndex(quads: number): THREE.BufferAttribute {
  const index = new Uint32Array(quads * 6);
  for (let quad = 0; quad < quads; quad++) {
    index.set([0, 1, 2, 0, 2, 3].map((corner) => quad * 4 + corner), quad * 6);
  }
  return new THREE.BufferAttribute(index, 1);
}

/** Index ranges of the wanted face directions; neighbours in the buffer are drawn as one. */
function rangesOf(wanted: boolean[], starts: number[]): THREE.GeometryGroup[] {
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
