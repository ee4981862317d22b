// What of a scene is drawn: classes by the legend, cells by the slice and the section box.

import type { View } from "../store";
import { isOccupied } from "./volume";
import type { Vec3 } from "../wire";

import type { Seen } from "./pick";

export function seenOf(view: View, shape: Vec3): Seen {
  const visible = Array.from(
    { length: 256 },
    (_, id) => isOccupied(id) && (view.solo === null ? !view.hidden.has(id) : id === view.solo),
  );
  const low: Vec3 = [0, 0, 0];
  const high: Vec3 = [...shape];
  const cut = (axis: number, from: number, to: number) => {
    low[axis] = Math.max(low[axis]!, Math.min(from, to));
    high[axis] = Math.min(high[axis]!, Math.max(from, to) + 1);
  };
  if (view.slice) cut(view.slice.axis, view.slice.low, view.slice.high);
  if (view.section) {
    for (let axis = 0; axis < 3; axis++) cut(axis, view.section.low[axis]!, view.section.high[axis]!);
  }
  return { visible, low, high };
}
