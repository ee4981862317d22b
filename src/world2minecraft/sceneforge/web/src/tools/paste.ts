// Copies selected cells to another place: what is copied hangs at the pointer until it is set down.

import { TEXT } from "../text";
import type { Vec3 } from "../wire";
import { cannotEdit } from "../ui/blocked";
import { boundsOf, cellOf, flatOf, isInside, runsOf } from "./cells";
import type { Desk, Gesture } from "./tool";

const GHOST = "#7fd6a4";
const AXES = ["x", "y", "z"] as const;
type Axis = (typeof AXES)[number];

const NUDGES: Record<string, Vec3> = {
  ArrowLeft: [-1, 0, 0],
  ArrowRight: [1, 0, 0],
  ArrowDown: [0, -1, 0],
  ArrowUp: [0, 1, 0],
  PageUp: [0, 0, 1],
  PageDown: [0, 0, -1],
};

export function pasteActions(desk: Desk): void {
  const { actions, store, toast } = desk.app;
  let copied: number[] = [];
  actions.on("cells.copy", {
    run: () => {
      copied = [...store.get().selectedCells];
      toast(TEXT.tools.copied(copied.length));
    },
    why: () => (store.get().selectedCells.size ? "" : TEXT.why.noCells),
  });
  actions.on("cells.paste", {
    run: () => desk.begin(hanging(desk, copied)),
    why: () => cannotEdit(store) || (copied.length ? "" : TEXT.why.nothingCopied),
  });
}

/** The copy at the pointer. X, Y and Z mirror it, arrows move it, a click or Enter sets it down. */
function hanging({ app }: Desk, copied: readonly number[]): Gesture {
  const { scene } = app.store.get();
  const shape = scene?.shape ?? [1, 1, 1];
  const box = boundsOf(copied, shape) ?? { low: [0, 0, 0], high: [0, 0, 0] };
  let by: Vec3 = [0, 0, 0];
  let mirror: Axis | null = null;
  const show = (): void => {
    const there = copied.map((flat) => placed(cellOf(flat, shape), by, mirror, box));
    const inside = there.filter((cell) => isInside(cell, shape)).map((cell) => flatOf(cell, shape));
    app.view.setOverlay("paste", runsOf(inside), GHOST);
  };
  const done = (): void => {
    app.view.setOverlay("paste", null, GHOST);
    app.store.set({ status: "" });
  };
  app.store.set({ status: TEXT.tools.pasting });
  show();
  return {
    sticks: true,
    move: ({ x, y }) => {
      const hit = app.view.pick(x, y);
      if (!hit) return;
      // Its middle stands on what is under the pointer.
      const middle = [0, 1].map((axis) => Math.floor((box.low[axis as 0] + box.high[axis as 0]) / 2));
      by = [hit.cell[0] - (middle[0] ?? 0), hit.cell[1] - (middle[1] ?? 0), hit.cell[2] + 1 - box.low[2]];
      show();
    },
    key: ({ key }) => {
      const axis = AXES.find((one) => one === key.toLowerCase());
      const step = NUDGES[key];
      if (axis) mirror = mirror === axis ? null : axis;
      else if (step) by = by.map((value, at) => value + step[at as 0]) as Vec3;
      else return false;
      show();
      return true;
    },
    end: () => {
      done();
      const { locked } = app.store.get().view;
      void app.do({ op: "paste", cells: runsOf(copied), by, mirror, locked: [...locked] });
    },
    cancel: done,
  };
}

function placed(cell: Vec3, by: Vec3, mirror: Axis | null, box: { low: Vec3; high: Vec3 }): Vec3 {
  return cell.map((at, axis) => {
    const turned = AXES[axis] === mirror ? box.low[axis as 0] + box.high[axis as 0] - at : at;
    return turned + by[axis as 0];
  }) as Vec3;
}
