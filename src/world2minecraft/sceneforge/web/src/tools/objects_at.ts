// Objects and the screen: which is under the pointer, and which cells are its own.

import type { App } from "../ui/slots";
import type { SceneObject, Vec3 } from "../wire";
import { cellOf, flatOf, isInside } from "./cells";

const REACH_PX = 12; // a centre is hit within

/** The object whose centre is drawn under the pointer. */
export function centreAt({ store, view }: App, x: number, y: number): SceneObject | null {
  const { objects, view: look } = store.get();
  let best: SceneObject | null = null;
  let nearest = REACH_PX;
  for (const one of objects.values()) {
    if (isHidden(one.class_id, look.hidden, look.solo)) continue;
    const at = view.project(one.center_m);
    const far = at ? Math.hypot(at[0] - x, at[1] - y) : Infinity;
    if (far < nearest) [best, nearest] = [one, far];
  }
  return best;
}

/** The object under the pointer: by its centre, else by the cell that is hit. */
export function objectAt(app: App, x: number, y: number): SceneObject | null {
  const hit = centreAt(app, x, y);
  if (hit) return hit;
  const picked = app.view.pick(x, y);
  return (picked?.object && app.store.get().objects.get(picked.object)) || null;
}

export function isHidden(id: number, hidden: ReadonlySet<number>, solo: number | null): boolean {
  return solo === null ? hidden.has(id) : solo !== id;
}

export function cellsOfObject(instance: Uint16Array, id: number): number[] {
  const flats: number[] = [];
  for (let flat = 0; flat < instance.length; flat++) if (instance[flat] === id) flats.push(flat);
  return flats;
}

/** Cells moved by whole cells; those that leave the grid are left out. */
export function shifted(flats: readonly number[], by: Vec3, shape: Vec3): number[] {
  const there: number[] = [];
  for (const flat of flats) {
    const cell = cellOf(flat, shape).map((at, axis) => at + by[axis as 0]) as Vec3;
    if (isInside(cell, shape)) there.push(flatOf(cell, shape));
  }
  return there;
}

/** The upright box around an object, in metres. */
export function boxOf({ center_m, size_m, yaw_deg }: SceneObject): { low: Vec3; high: Vec3 } {
  const turn = (yaw_deg * Math.PI) / 180;
  const [cos, sin] = [Math.abs(Math.cos(turn)), Math.abs(Math.sin(turn))];
  const half = [
    (size_m[0] * cos + size_m[1] * sin) / 2,
    (size_m[0] * sin + size_m[1] * cos) / 2,
    size_m[2] / 2,
  ];
  const low = center_m.map((at, axis) => at - (half[axis] ?? 0)) as Vec3;
  const high = center_m.map((at, axis) => at + (half[axis] ?? 0)) as Vec3;
  return { low, high };
}
