// Which cells lie behind a shape drawn on the screen.

import { walkRay, type Seen } from "./pick";
import { isOccupied, type Volume } from "./volume";
import type { Vec3 } from "../wire";

/** How far a selection reaches: the surface, a number of cells behind it, or all the way. */
export type DepthLimit = "surface" | "through" | number;
export type Point = [number, number];
export type RayOf = (x: number, y: number) => { from: Vec3; direction: Vec3 };
export type Project = (cell: Vec3) => Point | null; // a point in cells to pixels

/** Whether a point lies in a polygon; sides that cross count as even-odd. */
export function inPolygon([x, y]: Point, polygon: readonly Point[]): boolean {
  let inside = false;
  for (let i = 0, j = polygon.length - 1; i < polygon.length; j = i++) {
    const [ax, ay] = polygon[i]!;
    const [bx, by] = polygon[j]!;
    if (ay > y !== by > y && x < ((bx - ax) * (y - ay)) / (by - ay) + ax) inside = !inside;
  }
  return inside;
}

/**
 * Flat numbers of the drawn cells that a polygon covers.
 *
 * "through" takes all whose middle lies in it. Otherwise rays go through its pixels, and each takes
 * the first cell that it meets and `limit` occupied cells more behind it.
 */
export function cellsInPolygon(
  volume: Volume,
  seen: Seen,
  polygon: readonly Point[],
  limit: DepthLimit,
  project: Project,
  rayOf: RayOf,
): number[] {
  if (limit === "through") return cellsThrough(volume, seen, polygon, project);
  const { labels, shape } = volume;
  const more = limit === "surface" ? 0 : limit;
  const found = new Set<number>();
  const [low, high] = boundsOf(polygon);
  for (let y = low[1] + RAY_PX / 2; y < high[1]; y += RAY_PX)
    for (let x = low[0] + RAY_PX / 2; x < high[0]; x += RAY_PX) {
      if (!inPolygon([x, y], polygon)) continue;
      const { from, direction } = rayOf(x, y);
      let left = more;
      walkRay(seen, from, direction, (cell) => {
        const flat = (cell[0] * shape[1] + cell[1]) * shape[2] + cell[2];
        const label = labels[flat]!;
        if (!isOccupied(label) || !seen.visible[label]) return false;
        found.add(flat);
        return left-- <= 0;
      });
    }
  return [...found].sort((a, b) => a - b);
}

const RAY_PX = 2; // between rays: what shows fewer pixels may be missed

function cellsThrough(
  { labels, shape }: Volume,
  seen: Seen,
  polygon: readonly Point[],
  project: Project,
): number[] {
  const found: number[] = [];
  const [low, high] = boundsOf(polygon);
  for (let x = seen.low[0]; x < seen.high[0]; x++)
    for (let y = seen.low[1]; y < seen.high[1]; y++)
      for (let z = seen.low[2]; z < seen.high[2]; z++) {
        const flat = (x * shape[1] + y) * shape[2] + z;
        const label = labels[flat]!;
        if (!isOccupied(label) || !seen.visible[label]) continue;
        const at = project([x + 0.5, y + 0.5, z + 0.5]);
        if (!at || at[0] < low[0] || at[1] < low[1] || at[0] > high[0] || at[1] > high[1]) continue;
        if (inPolygon(at, polygon)) found.push(flat);
      }
  return found;
}

function boundsOf(polygon: readonly Point[]): [Point, Point] {
  const xs = polygon.map(([x]) => x);
  const ys = polygon.map(([, y]) => y);
  return [
    [Math.min(...xs), Math.min(...ys)],
    [Math.max(...xs), Math.max(...ys)],
  ];
}
