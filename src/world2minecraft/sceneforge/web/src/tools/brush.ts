// Paints and erases cells. A stroke is one command, sent when the button is let go; until then it
// is only seen. What the stroke hits is the room as it was, so it does not climb onto itself.

import type { Vec3 } from "../wire";
import { flatOf, isInside, line, runsOf, stamp, UNSEEN } from "./cells";
import type { Desk, Gesture, Press, Tool } from "./tool";

const ERASED = "#ff5252";
const STEPS: Vec3[] = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]]; // prettier-ignore

export function brushTool(desk: Desk, id: "brush" | "erase"): Tool {
  const erases = id === "erase";
  const { view } = desk.app;
  return {
    id,
    cursor: "crosshair",
    press: (at) => stroke(desk, erases, at),
    hover: (at) => {
      const cell = at && aim(desk, erases, at);
      const cells = cell ? under(desk, erases, cell) : [];
      view.setOverlay("brush", cells.length ? runsOf(cells) : null, colourOf(desk, erases));
    },
    stop: () => view.setOverlay("brush", null, ERASED),
  };
}

function stroke(desk: Desk, erases: boolean, from: Press): Gesture {
  const { app } = desk;
  const cells = new Set<number>();
  let last: Vec3 | null = null;
  const draw = (at: Press): void => {
    const cell = aim(desk, erases, at);
    if (!cell) {
      last = null;
      return;
    }
    for (const step of line(last ?? cell, cell)) for (const one of under(desk, erases, step)) cells.add(one);
    last = cell;
    app.view.setOverlay("brush", runsOf(cells), colourOf(desk, erases));
  };
  draw(from);
  return {
    move: draw,
    end: () => {
      app.view.setOverlay("brush", null, ERASED);
      if (!cells.size) return;
      const { options, view } = app.store.get();
      const class_id = erases ? 0 : options.classId;
      const verb = erases || !class_id ? "erase" : options.fills === "occupied" ? "relabel" : "paint";
      void app.do({ op: "set_cells", cells: runsOf(cells), class_id, verb, locked: [...view.locked] });
    },
    cancel: () => app.view.setOverlay("brush", null, ERASED),
  };
}

/** The cell that the brush is centred on: what is hit, or what lies before it where cells are added. */
function aim({ app }: Desk, erases: boolean, at: Press): Vec3 | null {
  const hit = app.view.pick(at.x, at.y);
  const { scene, options } = app.store.get();
  if (!hit || !scene) return null;
  if (erases || options.fills === "occupied") return hit.cell;
  const step = STEPS[hit.face] ?? [0, 0, 0];
  const before = hit.cell.map((value, axis) => value + step[axis as 0]) as Vec3;
  return isInside(before, scene.shape) ? before : hit.cell;
}

/** The cells that a brush on a cell changes: locked ones and those of the wrong kind are left out. */
function under({ app }: Desk, erases: boolean, cell: Vec3): number[] {
  const { scene, labels, options, view } = app.store.get();
  if (!scene) return [];
  const kind = erases ? "occupied" : options.fills;
  const shown = (flat: number): boolean => {
    const label = labels[flat] ?? UNSEEN;
    const occupied = label !== 0 && label !== UNSEEN;
    if (view.locked.has(label) || (erases && view.hidden.has(label))) return false;
    return kind === "all" || (kind === "occupied") === occupied;
  };
  const found = stamp(cell, scene.shape, options.shape, options.size).filter(shown);
  return found.length || !erases ? found : [flatOf(cell, scene.shape)].filter(shown);
}

function colourOf({ app }: Desk, erases: boolean): string {
  const { scene, options } = app.store.get();
  const colour = scene?.classes[options.classId]?.colour;
  return erases || !options.classId || !colour ? ERASED : `rgb(${colour.join(",")})`;
}
