// Ways to look: along axes, at the selection, with classes hidden or alone, cut by slices.

import { boxOf } from "../tools/objects_at";
import { TEXT } from "../text";
import type { Vec3 } from "../wire";
import { focusCells } from "./floaters";
import { toggleSeen } from "./legend";
import { selectedOf } from "./object_actions";
import { moveSlice } from "./slices";
import type { App } from "./slots";

export function viewActions(app: App): void {
  const { actions, store, view } = app;
  const scene = (): string => (store.get().scene ? "" : TEXT.why.noScene);
  const on = (id: string, run: () => void): void => actions.on(id, { run, why: scene });
  on("view.reset", () => view.frame());
  on("view.focus", () => lookAtSelection(app));
  on("view.top", () => view.lookAlong(2));
  on("view.front", () => view.lookAlong(1));
  on("view.side", () => view.lookAlong(0));
  actions.on("view.ortho", {
    run: () => (view.orbit = { ...view.orbit, ortho: !view.orbit.ortho }),
    why: scene,
  });
  cameraActions(view, on);
  actions.on("view.unhide", {
    run: () => store.setView({ hidden: new Set(), solo: null }),
    why: () => scene() || (store.get().view.hidden.size || store.get().view.solo !== null ? "" : TEXT.why.allShown),
  });
  const ofClass = (): string => scene() || (classInHand(app) ? "" : TEXT.why.aClass);
  actions.on("view.hide", { run: () => toggleSeen(app, classInHand(app), false), why: ofClass });
  actions.on("view.solo", { run: () => toggleSeen(app, classInHand(app), true), why: ofClass });
  actions.on("view.edges", {
    run: () => store.setView({ edges: !store.get().view.edges }),
    why: scene,
    active: () => store.get().view.edges,
  });
  on("slice.up", () => moveSlice(app, 1));
  on("slice.down", () => moveSlice(app, -1));
}

const TURN = Math.PI / 12; // radians a key
const PAN = 0.12; // share of the view's height

/** The camera by keys alone. */
function cameraActions(view: App["view"], on: (id: string, run: () => void) => void): void {
  on("camera.left", () => view.turn(-TURN, 0));
  on("camera.right", () => view.turn(TURN, 0));
  on("camera.up", () => view.turn(0, TURN));
  on("camera.down", () => view.turn(0, -TURN));
  on("camera.panLeft", () => view.pan(PAN, 0));
  on("camera.panRight", () => view.pan(-PAN, 0));
  on("camera.panUp", () => view.pan(0, -PAN));
  on("camera.panDown", () => view.pan(0, PAN));
  on("camera.closer", () => view.zoom(1 / 1.25));
  on("camera.away", () => view.zoom(1.25));
}

/** The class of what is selected, else the chosen one. */
function classInHand(app: App): number {
  const { selectedCells, labels, options } = app.store.get();
  const [cell] = selectedCells;
  return selectedOf(app)[0]?.class_id ?? (cell === undefined ? options.classId : (labels[cell] ?? 0));
}

function lookAtSelection(app: App): void {
  const those = selectedOf(app).map(boxOf);
  const { selectedCells } = app.store.get();
  if (those.length) {
    const side = (of: (...values: number[]) => number, end: "low" | "high"): Vec3 =>
      [0, 1, 2].map((axis) => of(...those.map((box) => box[end][axis as 0]))) as Vec3;
    app.view.focus({ low: side(Math.min, "low"), high: side(Math.max, "high") });
  } else if (selectedCells.size) focusCells(app, [...selectedCells]);
  else app.view.frame();
}
