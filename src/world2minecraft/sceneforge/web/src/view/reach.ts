// What lies under pixels: cells, points, regions, and what hides what. No drawing.

import type { Store } from "../store";
import type { Vec3 } from "../wire";
import { pickCell, walkRay, type Hit, type Seen } from "./pick";
import { cellsInPolygon, type DepthLimit, type Point } from "./regions";
import type { Sight } from "./sight";
import { flatOf, isOccupied } from "./volume";

export interface Picked extends Hit {
  object?: number;
}

export interface Ray {
  from: Vec3; // metres
  direction: Vec3;
}

export class Reach {
  /** Finds what a ray meets where something else than the voxels is drawn. */
  picker: ((ray: Ray) => Picked | null) | null = null;
  labels: Uint8Array = new Uint8Array(0);

  constructor(
    private readonly store: Store,
    private readonly sight: Sight,
    private readonly seen: () => Seen,
  ) {}

  inCells(point: Vec3): Vec3 {
    const { origin_m, voxel_m } = this.store.get().scene!;
    return point.map((value, i) => (value - origin_m[i]!) / voxel_m) as Vec3;
  }

  pick(x: number, y: number): Picked | null {
    const { scene, instance } = this.store.get();
    if (!scene || !this.labels.length) return null;
    const { from, direction } = this.sight.ray(x, y);
    if (this.picker) return this.picker({ from, direction });
    const ray = direction.map((d) => d / scene.voxel_m) as Vec3;
    const hit = pickCell({ labels: this.labels, shape: scene.shape }, this.seen(), this.inCells(from), ray);
    if (!hit) return null;
    const object = instance[hit.flat];
    return object ? { ...hit, object } : hit;
  }

  pointAt(x: number, y: number): Vec3 | null {
    const hit = this.pick(x, y);
    if (!hit) return null;
    const { from, direction } = this.sight.ray(x, y);
    return from.map((value, i) => value + hit.t * direction[i]!) as Vec3;
  }

  toRoom(x: number, y: number, plane: { axis: 0 | 1 | 2; at: number }): Vec3 | null {
    const { from, direction } = this.sight.ray(x, y);
    const t = (plane.at - from[plane.axis]) / direction[plane.axis];
    if (!Number.isFinite(t) || t < 0) return null;
    return from.map((value, i) => value + t * direction[i]!) as Vec3;
  }

  lasso(polygon: readonly Point[], limit: DepthLimit): number[] {
    const { scene } = this.store.get();
    if (!scene || !this.labels.length || polygon.length < 3) return [];
    const { origin_m: origin, voxel_m: voxel, shape } = scene;
    const toPixels = this.sight.projector();
    const project = (cell: Vec3) => toPixels(cell.map((c, i) => origin[i]! + c * voxel) as Vec3);
    const rayOf = (x: number, y: number) => {
      const { from, direction } = this.sight.ray(x, y);
      return { from: this.inCells(from), direction };
    };
    return cellsInPolygon({ labels: this.labels, shape }, this.seen(), polygon, limit, project, rayOf);
  }

  /** Whether drawn cells of others than the object at a point, in metres, hide it. */
  isCovered(point: Vec3): boolean {
    const { scene, instance } = this.store.get();
    const pixel = this.sight.project(point);
    if (!scene || !this.labels.length || !pixel) return false;
    const { from, direction } = this.sight.ray(...pixel);
    const ray = direction.map((d) => d / scene.voxel_m) as Vec3;
    const [start, end] = [this.inCells(from), this.inCells(point)];
    const own = instance[flatOf(scene.shape, ...(end.map(Math.floor) as Vec3))];
    const length = Math.hypot(...end.map((c, i) => c - start[i]!)) / Math.hypot(...ray);
    const seen = this.seen();
    let covered = false;
    walkRay(seen, start, ray, (cell, _, t) => {
      const flat = flatOf(scene.shape, ...cell);
      const label = this.labels[flat]!;
      covered = t < length && isOccupied(label) && seen.visible[label]! && instance[flat] !== own;
      return covered || t >= length;
    });
    return covered;
  }
}
