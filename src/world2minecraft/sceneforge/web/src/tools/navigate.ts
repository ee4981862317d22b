// Looks around; a click selects. In Objects mode a centre that is dragged moves its object.

import { grab } from "./move";
import { centreAt, objectAt } from "./objects_at";
import { combineOf } from "./selection";
import type { Desk, Gesture, Press, Tool } from "./tool";

const CLICK_PX = 4;

export function navigateTool(desk: Desk): Tool {
  const { app } = desk;
  listenForClicks(desk);
  const inObjects = (): boolean => app.store.get().mode === "objects";
  return {
    id: "navigate",
    cursor: "default",
    claims: (at) => inObjects() && !at.shiftKey && !at.ctrlKey && centreAt(app, at.x, at.y) !== null,
    press: (at) => dragOrSelect(desk, at),
    hover: (at) => {
      const over = at && inObjects() ? objectAt(app, at.x, at.y) : null;
      app.canvas.style.cursor = over ? "pointer" : "default";
    },
  };
}

/** A press on a centre: it moves where it is dragged, and is selected where it is clicked. */
function dragOrSelect(desk: Desk, from: Press): Gesture | null {
  const one = centreAt(desk.app, from.x, from.y);
  if (!one) return null;
  const moving = grab(desk, one, from);
  let moved = false;
  return {
    move: (at) => {
      moved ||= Math.hypot(at.x - from.x, at.y - from.y) >= CLICK_PX;
      if (moved) moving.move(at);
    },
    end: (at) => {
      if (moved) moving.end(at);
      else moving.cancel();
      desk.selection.objects([one.id], moved ? "replace" : combineOf(at));
    },
    cancel: () => moving.cancel(),
  };
}

/** The view turns by a drag of the same button: only a press that stays in place selects. */
function listenForClicks(desk: Desk): void {
  const { app, selection } = desk;
  let down: { x: number; y: number } | null = null;
  app.canvas.addEventListener("pointerdown", (event) => {
    const free = app.store.get().tool === "navigate" && event.button === 0;
    down = free ? { x: event.offsetX, y: event.offsetY } : null;
  });
  app.canvas.addEventListener("pointerup", (event) => {
    if (!down || event.button !== 0) return;
    const moved = Math.hypot(event.offsetX - down.x, event.offsetY - down.y) >= CLICK_PX;
    const { x, y } = down;
    down = null;
    const { mode } = app.store.get();
    if (moved || mode === "walk" || mode === "build" || centreAt(app, x, y)) return;
    const one = objectAt(app, x, y);
    if (one) selection.objects([one.id], combineOf(event));
    else if (combineOf(event) === "replace") selection.objects([]);
  });
}
