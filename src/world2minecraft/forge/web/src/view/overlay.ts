// Cells lit up over the scene: a selection, a preview, a brush. Each has a name and a colour.

import * as THREE from "three";

import { quadIndex } from "./chunk";
import { flatMaterial } from "./plain";
import { cellOf } from "./volume";
import type { Run, Vec3 } from "../wire";

const MOST = 400_000; // Cells drawn of one overlay; more would stall software GL.
const GROWN = 0.02; // Share of a cell by which overlay cubes stand out.
const SIDES: readonly Vec3[] = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]];

/** The outer faces of some cells, as corner positions in cells; four a face. */
export function facesOfCells(runs: readonly Run[], shape: Vec3): Float32Array {
  const cells = new Set<number>();
  for (const [first, length] of runs) {
    for (let flat = first; flat < first + length && cells.size < MOST; flat++) cells.add(flat);
  }
  const ahead = [shape[1] * shape[2], shape[2], 1];
  const corners: number[] = [];
  for (const flat of cells) {
    const cell = cellOf(shape, flat);
    SIDES.forEach((side, face) => {
      const axis = face % 3;
      const next = cell[axis]! + side[axis]!;
      const inside = next >= 0 && next < shape[axis]!;
      if (inside && cells.has(flat + ahead[axis]! * side[axis]!)) return;
      pushFace(corners, cell, face);
    });
  }
  return Float32Array.from(corners);
}

function pushFace(corners: number[], cell: Vec3, face: number): void {
  const axis = face % 3;
  const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
  const round = [[0, 0], [1, 0], [1, 1], [0, 1]] as const;
  for (const [a, b] of face < 3 ? round : [...round].reverse()) {
    const at: Vec3 = [...cell];
    at[axis]! += face < 3 ? 1 + GROWN : -GROWN;
    at[u]! += a ? 1 + GROWN : -GROWN;
    at[v]! += b ? 1 + GROWN : -GROWN;
    corners.push(...at);
  }
}

export class Overlays {
  readonly group = new THREE.Group();
  private readonly shown = new Map<string, THREE.Mesh>();

  constructor() {
    this.group.matrixAutoUpdate = false;
  }

  setPlace(voxel: number, origin: Vec3): void {
    this.group.matrix.makeScale(voxel, voxel, voxel).setPosition(...origin);
    this.group.updateMatrixWorld(true);
  }

  set(name: string, runs: readonly Run[] | null, shape: Vec3, colour: string, opacity = 0.5): void {
    const old = this.shown.get(name);
    if (old) {
      this.group.remove(old);
      old.geometry.dispose();
      (old.material as THREE.Material).dispose();
      this.shown.delete(name);
    }
    if (!runs?.length) return;
    const corners = facesOfCells(runs, shape);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(corners, 3));
    geometry.setIndex(quadIndex(corners.length / 12));
    const material = flatMaterial(colour, opacity);
    const mesh = new THREE.Mesh(geometry, material);
    mesh.renderOrder = 1;
    this.shown.set(name, mesh);
    this.group.add(mesh);
  }

  clear(): void {
    for (const name of [...this.shown.keys()]) this.set(name, null, [1, 1, 1], "");
  }
}
