// The voxels of a scene as chunks on the GPU: how fine each is drawn, which must be meshed, and
// which of their faces can be seen.

import * as THREE from "three";

import { Chunk, meshOf, quadIndex, rangesOf, type Step } from "./chunk";
import type { VoxelMaterial } from "./material";
import { CHUNK, FACES, meshChunk, type ChunkMesh, type Style } from "./mesher";
import { Pool } from "./pool";
import { stepFor } from "./quality";
import type { Meshed } from "./worker";
import type { Vec3 } from "../wire";

const SYNCHRONOUS = 12; // Chunks meshed at once; more go to the workers.
const MANY = 64; // Missing chunks from which on a rough picture comes first.
const BITS = Math.log2(CHUNK);
const SPHERE = (CHUNK / 2) * Math.sqrt(3);

/** Where a frame is seen from, in cells. */
export interface Aim {
  eye: Vec3 | null; // null: parallel rays
  direction: Vec3;
  frustum: THREE.Frustum; // in cells
  /** How many pixels large a cell is at a distance, in cells. */
  pixels: (distance: number) => number;
  coarse: number;
}

export class Chunks {
  readonly group = new THREE.Group();
  /** Whether the last frame showed all that it should. */
  settled = true;
  /** How many meshes were made. */
  made = 0;
  private chunks: Chunk[] = [];
  private counts: Vec3 = [0, 0, 0];
  private labels: Uint8Array = new Uint8Array(0);
  private shape: Vec3 = [0, 0, 0];
  private style: Style = "greedy";
  private stamp = 0; // of the last change: no two states of a chunk have the same
  private index = quadIndex(4096);
  private readonly pool = new Pool((meshed) => this.receive(meshed));

  constructor(
    private readonly material: VoxelMaterial,
    private readonly changed: () => void,
  ) {
    this.group.matrixAutoUpdate = false;
  }

  get quads(): number {
    return this.chunks.reduce((sum, chunk) => sum + chunk.quads, 0);
  }

  get bytes(): number {
    return this.quads * 32 + this.index.array.byteLength;
  }

  /** Begin with another volume. */
  load(labels: Uint8Array, shape: Vec3, voxel: number, origin: Vec3): void {
    this.clear();
    this.labels = labels;
    this.shape = shape;
    this.group.matrix.makeScale(voxel, voxel, voxel).setPosition(...origin);
    this.group.updateMatrixWorld(true);
    this.counts = shape.map((side) => Math.ceil(side / CHUNK)) as Vec3;
    const [nx, ny, nz] = this.counts;
    this.stamp += 1;
    for (let key = 0; key < nx * ny * nz; key++) {
      const low = [Math.floor(key / (ny * nz)), Math.floor(key / nz) % ny, key % nz];
      this.chunks.push(new Chunk(key, low.map((n) => n * CHUNK) as Vec3, this.stamp));
    }
    this.pool.setVolume(labels, shape);
  }

  /** Cells changed: their chunks, and those that touch them, are drawn anew. */
  touch(flats: Iterable<number>): void {
    this.stamp += 1;
    for (const key of this.touchedBy(flats)) {
      const chunk = this.chunks[key]!;
      chunk.version = this.stamp;
      chunk.touched = true;
    }
    this.pool.setVolume(this.labels, this.shape);
  }

  setStyle(style: Style): void {
    this.style = style;
  }

  /** Make ready what a frame shows: meshes, their fineness, the sides that face the camera. */
  aim(aim: Aim): void {
    const missing: { chunk: Chunk; step: Step; away: number }[] = [];
    const sphere = new THREE.Sphere();
    for (const chunk of this.chunks) {
      sphere.set(chunk.middle, SPHERE);
      if (!aim.frustum.intersectsSphere(sphere)) {
        chunk.show(null);
        continue;
      }
      const away = aim.eye ? Math.hypot(...aim.eye.map((e, i) => e - chunk.low[i]! - CHUNK / 2)) : 0;
      const wanted = stepFor(aim.pixels(Math.max(away - SPHERE, 1)), aim.coarse);
      const step = this.style === "cubes" ? 1 : wanted;
      if (!chunk.isFresh(step, this.style)) missing.push({ chunk, step, away });
      this.turn(chunk, step, aim);
    }
    this.settled = missing.length === 0;
    if (!this.settled) this.order(missing.sort((a, b) => a.away - b.away), aim);
  }

  dispose(): void {
    this.clear();
    this.pool.dispose();
  }

  private clear(): void {
    for (const chunk of this.chunks) for (const step of [1, 2, 4] as const) chunk.drop(step);
    this.chunks = [];
    this.pool.replace([]);
  }

  private turn(chunk: Chunk, step: Step, { eye, direction }: Aim): void {
    const best = chunk.best(step, this.style);
    chunk.show(best);
    if (!best?.mesh) return;
    const faces = [0, 1, 2, 3, 4, 5].map((face) => {
      const axis = face % 3;
      if (!eye) return face < 3 ? direction[axis]! < 0 : direction[axis]! > 0;
      return face < 3 ? eye[axis]! > chunk.low[axis]! : eye[axis]! < chunk.low[axis]! + CHUNK;
    });
    best.mesh.geometry.groups = rangesOf(faces, best.starts);
  }

  private order(missing: { chunk: Chunk; step: Step }[], aim: Aim): void {
    const now = this.chunks.length <= SYNCHRONOUS ? missing : missing.filter(({ chunk }) => chunk.touched);
    if (now.length <= SYNCHRONOUS) {
      for (const { chunk, step } of now) {
        this.put(chunk, step, meshChunk(this.labels, this.shape, chunk.low, step, this.style), this.style);
        this.turn(chunk, step, aim);
      }
    }
    const left = missing.filter(({ chunk, step }) => !chunk.isFresh(step, this.style));
    this.settled = left.length === 0;
    const rough = left.length > MANY && this.style === "greedy";
    this.pool.replace(
      left.map(({ chunk, step }) => ({
        key: chunk.key,
        epoch: chunk.version,
        low: chunk.low,
        step: rough && !chunk.built.size ? 4 : step,
        style: this.style,
      })),
    );
  }

  private receive({ key, epoch, step, style, mesh }: Meshed): void {
    const chunk = this.chunks[key];
    if (!chunk || chunk.version !== epoch || style !== this.style) return;
    this.put(chunk, step as Step, mesh, style);
    this.changed();
  }

  private put(chunk: Chunk, step: Step, made: ChunkMesh, style: Style): void {
    chunk.drop(step);
    this.made += 1;
    const quads = made.starts[FACES]!;
    let mesh: THREE.Mesh | null = null;
    if (quads) {
      this.growIndex(quads);
      mesh = meshOf(chunk.low, made, this.index, style === "cubes" ? this.material.cubes : this.material.greedy);
      mesh.visible = false;
      this.group.add(mesh);
      mesh.updateMatrixWorld(true);
    }
    chunk.built.set(step, { mesh, starts: made.starts, version: chunk.version, style });
    if (chunk.touched && step === 1) chunk.touched = false;
  }

  private growIndex(quads: number): void {
    if (this.index.count >= quads * 6) return;
    this.index = quadIndex(Math.max(quads, this.index.count / 3));
    for (const { built } of this.chunks) {
      for (const { mesh } of built.values()) mesh?.geometry.setIndex(this.index);
    }
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
      const row = (flat - z) / Z;
      const y = row % Y;
      const x = (row - y) / Y;
      const [cx, cy, cz] = [x >> BITS, y >> BITS, z >> BITS];
      add(cx, cy, cz);
      if (sideOf(x)) add(cx + sideOf(x), cy, cz);
      if (sideOf(y)) add(cx, cy + sideOf(y), cz);
      if (sideOf(z)) add(cx, cy, cz + sideOf(z));
    }
    return found;
  }
}

/** -1 or 1 for the first and last cell of a chunk along an axis: the neighbour's mesh sees it. */
function sideOf(at: number): -1 | 0 | 1 {
  const within = at & (CHUNK - 1);
  return within === 0 ? -1 : within === CHUNK - 1 ? 1 : 0;
}
