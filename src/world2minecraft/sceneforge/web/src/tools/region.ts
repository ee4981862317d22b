// Selects cells within a box or a lasso on the screen, as deep as the toolbar says.

import type { DepthLimit } from "../view/regions";
import { combineOf } from "./selection";
import type { Desk, Gesture, Press, Tool } from "./tool";

const LASSO_STEP_PX = 3;

function depthOf({ app }: Desk): DepthLimit {
  const { depth, surfaceOnly } = app.store.get().options;
  return surfaceOnly ? "surface" : depth || "through";
}

export function boxTool(desk: Desk): Tool {
  return { id: "box", cursor: "crosshair", press: (at) => boxGesture(desk, at) };
}

function boxGesture(desk: Desk, from: Press): Gesture {
  const { view } = desk.app;
  const clear = (): void => desk.marks.clear("box");
  return {
    move: (at) => desk.marks.polygon("box", corners(from, at)),
    end: (at) => {
      clear();
      const [x0, x1] = [Math.min(from.x, at.x), Math.max(from.x, at.x)];
      const [y0, y1] = [Math.min(from.y, at.y), Math.max(from.y, at.y)];
      desk.selection.cells(view.cellsInRect(x0, y0, x1, y1, depthOf(desk)), combineOf(at));
    },
    cancel: clear,
  };
}

function corners(from: Press, to: Press): [number, number][] {
  return [[from.x, from.y], [to.x, from.y], [to.x, to.y], [from.x, to.y]]; // prettier-ignore
}

export function lassoTool(desk: Desk): Tool {
  return { id: "lasso", cursor: "crosshair", press: (at) => lassoGesture(desk, at) };
}

function lassoGesture(desk: Desk, from: Press): Gesture {
  const points: [number, number][] = [[from.x, from.y]];
  const clear = (): void => desk.marks.clear("lasso");
  return {
    move: (at) => {
      const [x, y] = points[points.length - 1] ?? [0, 0];
      if (Math.hypot(at.x - x, at.y - y) < LASSO_STEP_PX) return;
      points.push([at.x, at.y]);
      desk.marks.polygon("lasso", points);
    },
    end: (at) => {
      clear();
      if (points.length < 3) return;
      desk.selection.cells(desk.app.view.lasso(points, depthOf(desk)), combineOf(at));
    },
    cancel: clear,
  };
}
