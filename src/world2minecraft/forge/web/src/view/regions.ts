// Which cells lie behind a shape drawn on the screen.

import { plus } from "./camera";
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
 * Flat numbers of the drawn cells whose middle the polygon covers.
 *
 * "through" takes all of them. Otherwise a cell counts that can be seen from the camera, or that
 * has at most `limit` occupied cells between it and what is seen first: found by the ray to it.
 */
export function cellsInPolygon(
  volume: Volume,
  seen: Seen,
  polygon: readonly Point[],
  limit: DepthLimit,
  project: Project,
  rayTo: (cell: Vec3) => { from: Vec3; direction: Vec3 },
): number[] {
  const { labels, shape } = volume;
  const found: number[] = [];
  const bounds = boundsOf(polygon);
  const behind = limit === "through" ? Infinity : limit === "surface" ? 0 : limit;
  for (let x = seen.low[0]; x < seen.high[0]; x++)
    for (let y = seen.low[1]; y < seen.high[1]; y++)
      for (let z = seen.low[2]; z < seen.high[2]; z++) {
        const flat = (x * shape[1] + y) * shape[2] + z;
        const label = labels[flat]!;
        if (!isOccupied(label) || !seen.visible[label]) continue;
        const middle: Vec3 = [x + 0.5, y + 0.5, z + 0.5];
        const at = project(middle);
        if (!at || !within(at, bounds) || !inPolygon(at, polygon)) continue;
        if (behind === Infinity || reached(volume, seen, flat, middle, behind, rayTo)) found.push(flat);
      }
  return found;
}

/** Surface cells are often seen only past a corner: rays go to the sides of the cell as well. */
const AIMS: readonly Vec3[] = [
  [0, 0, 0],
  [0.45, 0, 0],
  [-0.45, 0, 0],
  [0, 0.45, 0],
  [0, -0.45, 0],
  [0, 0, 0.45],
  [0, 0, -0.45],
];

function reached(
  { labels, shape }: Volume,
  seen: Seen,
  flat: number,
  middle: Vec3,
  behind: number,
  rayTo: (cell: Vec3) => { from: Vec3; direction: Vec3 },
): boolean {
  return AIMS.some((aim) => {
    const { from, direction } = rayTo(plus(middle, aim, 1));
    let passed = 0;
    let there = false;
    walkRay(seen, from, direction, (cell) => {
      const at = (cell[0] * shape[1] + cell[1]) * shape[2] + cell[2];
      if (at === flat) there = true;
      else if (isOccupied(labels[at]!) && seen.visible[labels[at]!]) passed += 1;
      return there || passed > behind;
    });
    return there;
  });
}

function boundsOf(polygon: readonly Point[]): [Point, Point] {
  const xs = polygon.map(([x]) => x);
  const ys = polygon.map(([, y]) => y);
  return [
    [Math.min(...xs), Math.min(...ys)],
    [Math.max(...xs), Math.max(...ys)],
  ];
}

function within([x, y]: Point, [low, high]: [Point, Point]): boolean {
  return x >= low[0] && y >= low[1] && x <= high[0] && y <= high[1];
}
