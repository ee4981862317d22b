// Measures between two points of the scene; the line stays until the next, or until Esc.

import { TEXT } from "../text";
import type { Vec3 } from "../wire";
import type { Desk, Press, Tool } from "./tool";

export function measureTool(desk: Desk): Tool {
  const { app, marks } = desk;
  let from: Vec3 | null = null;
  let to: Vec3 | null = null;
  const show = (): void => {
    const ends = from && to ? [app.view.project(from), app.view.project(to)] : [];
    if (from && to && ends[0] && ends[1]) marks.ruler("measure", ends[0], ends[1], words(from, to));
    else marks.clear("measure");
  };
  const clear = (): void => {
    from = to = null;
    show();
  };
  app.view.onFrame.push(show);
  const follow = (at: Press): void => {
    to = app.view.pointAt(at.x, at.y) ?? to;
    show();
  };
  return {
    id: "measure",
    cursor: "crosshair",
    press: (at) => {
      const point = app.view.pointAt(at.x, at.y);
      if (!point) return null;
      from = to = point;
      return {
        move: follow,
        end: () => {
          if (from && to) app.store.set({ status: TEXT.tools.measured(words(from, to)) });
        },
        cancel: clear,
      };
    },
    stop: clear,
  };
}

function words(from: Vec3, to: Vec3): string {
  const sides = from.map((value, axis) => Math.abs(to[axis as 0] - value)) as Vec3;
  return TEXT.tools.distance(Math.hypot(...sides), sides);
}
