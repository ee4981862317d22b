// Cells lit up over the scene: a selection, a preview, a brush. Each has a name and a colour.

import * as THREE from "three";

import { quadIndex } from "./chunk";
import { flatMaterial } from "./plain";
import { cellOf } from "./volume";
import type { Run, Vec3 } from "../wire";

const MOST = 400_000; // Cells drawn of one overlay; more would stall software GL.
const RAISED = 0.02; // Share of a cell by which faces stand out.
const BEHIND = 0.28; // Opacity of what lies behind others, as a share.
const LIGHT = [0.9, 0.96, 1, 0.86, 0.8, 0.66]; // by face, as of the voxels but weaker
const SIDES: readonly Vec3[] = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]];

/** The outer faces of some cells: corners in cells, four a face, and how light each corner is. */
export function facesOfCells(runs: readonly Run[], shape: Vec3): { corners: Float32Array; lights: Float32Array } {
  const cells = new Set<number>();
  for (const [first, length] of runs) {
    for (let flat = first; flat < first + length && cells.size < MOST; flat++) cells.add(flat);
  }
  const ahead = [shape[1] * shape[2], shape[2], 1];
  const corners: number[] = [];
  const lights: number[] = [];
  for (const flat of cells) {
    const cell = cellOf(shape, flat);
    SIDES.forEach((side, face) => {
      const axis = face % 3;
      const next = cell[axis]! + side[axis]!;
      const inside = next >= 0 && next < shape[axis]!;
      if (inside && cells.has(flat + ahead[axis]! * side[axis]!)) return;
      pushFace(corners, cell, face);
      const light = LIGHT[face]!;
      for (let corner = 0; corner < 4; corner++) lights.push(light, light, light, 1);
    });
  }
  return { corners: Float32Array.from(corners), lights: Float32Array.from(lights) };
}

function pushFace(corners: number[], cell: Vec3, face: number): void {
  const axis = face % 3;
  const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
  const round = [[0, 0], [1, 0], [1, 1], [0, 1]] as const;
  for (const [a, b] of face < 3 ? round : [...round].reverse()) {
    const at: Vec3 = [...cell];
    at[axis]! += face < 3 ? 1 + RAISED : -RAISED;
    at[u]! += a;
    at[v]! += b;
    corners.push(...at);
  }
}

export class Overlays {
  readonly group = new THREE.Group();
  private readonly shown = new Map<string, THREE.Mesh[]>();

  constructor() {
    this.group.matrixAutoUpdate = false;
  }

  setPlace(voxel: number, origin: Vec3): void {
    this.group.matrix.makeScale(voxel, voxel, voxel).setPosition(...origin);
    this.group.updateMatrixWorld(true);
  }

  set(name: string, runs: readonly Run[] | null, shape: Vec3, colour: string, opacity = 0.5): void {
    for (const old of this.shown.get(name) ?? []) {
      this.group.remove(old);
      old.geometry.dispose();
      (old.material as THREE.Material).dispose();
    }
    this.shown.delete(name);
    if (!runs?.length) return;
    const { corners, lights } = facesOfCells(runs, shape);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(corners, 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(lights, 4));
    geometry.setIndex(quadIndex(corners.length / 12));
    const ahead = flatMaterial(colour, opacity, { colours: true });
    const behind = flatMaterial(colour, opacity * BEHIND, { colours: true, depthFunc: THREE.GreaterDepth });
    const meshes = [ahead, behind].map((material) => new THREE.Mesh(geometry, material));
    for (const mesh of meshes) mesh.renderOrder = 1;
    this.shown.set(name, meshes);
    this.group.add(...meshes);
  }

  clear(): void {
    for (const name of [...this.shown.keys()]) this.set(name, null, [1, 1, 1], "");
  }
}
