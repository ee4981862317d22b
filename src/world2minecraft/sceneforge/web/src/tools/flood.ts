// Selects what is connected: all cells of the class that hold together by faces.

import { component, runsOf } from "./cells";
import { combineOf } from "./selection";
import type { Desk, Tool } from "./tool";

const HINT = "#ffffff";
const MOST_SHOWN = 20_000; // of what a click would select: more is seen without being lit

export function floodTool(desk: Desk): Tool {
  const { app } = desk;
  const clear = (): void => app.view.setOverlay("flood", null, HINT);
  let shown = -1;
  return {
    id: "flood",
    cursor: "crosshair",
    press: (at) => {
      const hit = app.view.pick(at.x, at.y);
      const { scene, labels } = app.store.get();
      const found = hit && scene ? component(hit.flat, labels, scene.shape) : [];
      return {
        move: () => undefined,
        end: (up) => {
          if (hit || combineOf(up) === "replace") desk.selection.cells(found, combineOf(up));
        },
        cancel: () => undefined,
      };
    },
    hover: (at) => {
      const hit = at && app.view.pick(at.x, at.y);
      const { scene, labels } = app.store.get();
      if ((hit?.flat ?? -1) === shown) return;
      shown = hit?.flat ?? -1;
      if (!hit || !scene) clear();
      else app.view.setOverlay("flood", runsOf(component(hit.flat, labels, scene.shape, MOST_SHOWN)), HINT);
    },
    stop: clear,
  };
}
