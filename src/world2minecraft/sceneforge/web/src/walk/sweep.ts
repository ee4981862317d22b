// A box moves among boxes: walk/sweep.py in TypeScript. What a box lies in already does not hold it.

import type { Vec3 } from "../wire";
import { TOUCH, type Box } from "./body";

const OTHERS = [[1, 2], [0, 2], [0, 1]] as const; // prettier-ignore

/** Whether a box lies over any of some boxes; touching is not lying over. */
export function overlapsAny(boxes: readonly Box[], box: Box, touch = TOUCH): boolean {
  return boxes.some(
    (one) => liesOver(one, box, 0, touch) && liesOver(one, box, 1, touch) && liesOver(one, box, 2, touch),
  );
}

/** How much of a way along one axis a box can go before it meets another. */
export function freeWay(boxes: readonly Box[], box: Box, axis: 0 | 1 | 2, way: number, touch = TOUCH): number {
  const [a, b] = OTHERS[axis];
  let free = way;
  for (const one of way === 0 ? [] : boxes) {
    if (!liesOver(one, box, a, touch) || !liesOver(one, box, b, touch)) continue;
    if (way > 0) {
      const gap = one[axis] - box[(axis + 3) as 3];
      if (gap >= -touch && gap < free) free = gap;
    } else {
      const gap = one[(axis + 3) as 3] - box[axis];
      if (gap <= touch && gap > free) free = gap;
    }
  }
  return free;
}

/** How much of a way a box can go: up or down, then the longer side first. */
export function swept(boxes: readonly Box[], box: Box, way: Vec3, touch = TOUCH): Vec3 {
  const order = Math.abs(way[0]) < Math.abs(way[2]) ? ([1, 2, 0] as const) : ([1, 0, 2] as const);
  const gone: Vec3 = [0, 0, 0];
  const here = [...box] as [number, number, number, number, number, number];
  for (const axis of order) {
    gone[axis] = freeWay(boxes, here, axis, way[axis], touch);
    here[axis] += gone[axis];
    here[(axis + 3) as 3] += gone[axis];
  }
  return gone;
}

/** How much of a way a box can go when it may step up by a height and down again. */
export function climbed(boxes: readonly Box[], box: Box, way: Vec3, height: number, touch = TOUCH): Vec3 {
  let best = swept(boxes, box, [way[0], height, way[2]], touch);
  const reach: Box = [
    box[0] + Math.min(way[0], 0), box[1], box[2] + Math.min(way[2], 0),
    box[3] + Math.max(way[0], 0), box[4], box[5] + Math.max(way[2], 0),
  ]; // prettier-ignore
  const up = freeWay(boxes, reach, 1, height, touch);
  if (up < height) {
    const [x, , z] = swept(boxes, movedBy(box, [0, up, 0]), [way[0], 0, way[2]], touch);
    if (x * x + z * z > best[0] * best[0] + best[2] * best[2]) best = [x, up, z];
  }
  const down = freeWay(boxes, movedBy(box, best), 1, way[1] - best[1], touch);
  return [best[0], best[1] + down, best[2]];
}

export function movedBy(box: Box, [x, y, z]: Vec3): Box {
  return [box[0] + x, box[1] + y, box[2] + z, box[3] + x, box[4] + y, box[5] + z];
}

function liesOver(one: Box, box: Box, axis: 0 | 1 | 2, touch: number): boolean {
  const high = (axis + 3) as 3;
  return one[axis] < box[high] - touch && one[high] > box[axis] + touch;
}
