// Moves an object by whole cells: by dragging, or after G with the pointer or the arrow keys.

import { TEXT } from "../text";
import type { SceneObject, Vec3 } from "../wire";
import { runsOf } from "./cells";
import { cellsOfObject, objectAt, shifted } from "./objects_at";
import type { Desk, Gesture, Press, Tool } from "./tool";

const GHOST = "#ffb35c";

const NUDGES: Record<string, Vec3> = {
  ArrowLeft: [-1, 0, 0],
  ArrowRight: [1, 0, 0],
  ArrowDown: [0, -1, 0],
  ArrowUp: [0, 1, 0],
  PageUp: [0, 0, 1],
  PageDown: [0, 0, -1],
};

/** Take hold of an object: what is seen moves with the pointer, the object itself at the end. */
export function grab(desk: Desk, one: SceneObject, from: Press | null): Gesture {
  const { view, store } = desk.app;
  const { scene, instance } = store.get();
  const cells = cellsOfObject(instance, one.id);
  const shape = scene?.shape ?? [1, 1, 1];
  const voxel = scene?.voxel_m ?? 1;
  const height = one.center_m[2];
  let start = from && view.toRoom(from.x, from.y, { axis: 2, at: height });
  let nudged: Vec3 = [0, 0, 0];
  let by: Vec3 = [0, 0, 0];
  const show = (next: Vec3): void => {
    by = next;
    view.setOverlay("move", runsOf(shifted(cells, by, shape)), GHOST);
    const to = placed(one, by, voxel);
    const at = view.project(to);
    const home = view.project(one.center_m);
    if (at && home) desk.marks.ruler("move", home, at, TEXT.tools.moved(by));
  };
  const done = (): void => {
    view.setOverlay("move", null, GHOST);
    desk.marks.clear("move");
  };
  return {
    move: (at) => {
      const there = view.toRoom(at.x, at.y, { axis: 2, at: height });
      if (!there) return;
      start ??= there;
      const base = start;
      const whole = there.map((value, axis) => Math.round((value - base[axis as 0]) / voxel));
      show([(whole[0] ?? 0) + nudged[0], (whole[1] ?? 0) + nudged[1], nudged[2]]);
    },
    key: (event) => {
      const step = NUDGES[event.key];
      if (!step) return false;
      nudged = nudged.map((value, axis) => value + step[axis as 0]) as Vec3;
      show(by.map((value, axis) => value + step[axis as 0]) as Vec3);
      return true;
    },
    end: () => {
      done();
      if (by.some((value) => value !== 0)) {
        void desk.app.do({ op: "move_object", id: one.id, to_m: placed(one, by, voxel) });
      }
    },
    cancel: done,
  };
}

function placed(one: SceneObject, by: Vec3, voxel: number): Vec3 {
  return one.center_m.map((at, axis) => at + by[axis as 0] * voxel) as Vec3;
}

export function moveTool(desk: Desk): Tool {
  const { app } = desk;
  return {
    id: "move",
    cursor: "move",
    start: () => {
      const [id, ...others] = app.store.get().selectedObjects;
      const one = id === undefined || others.length ? null : app.store.get().objects.get(id);
      if (!one) return;
      const held = grab(desk, one, null);
      const back = (): void => {
        if (app.store.get().tool === "move") app.store.set({ tool: "navigate" });
      };
      desk.begin({
        ...held,
        sticks: true,
        end: (at) => {
          held.end(at);
          back();
        },
        cancel: () => {
          held.cancel();
          back();
        },
      });
    },
    press: (at) => {
      const one = objectAt(app, at.x, at.y);
      if (!one) return null;
      desk.selection.objects([one.id]);
      return grab(desk, one, at);
    },
  };
}
