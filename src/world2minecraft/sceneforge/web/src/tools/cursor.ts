// A cell that keys move and paint: voxels without a mouse. Arrows move it as one sees the room.

import { TEXT } from "../text";
import { cannotEdit } from "../ui/blocked";
import type { App } from "../ui/slots";
import type { Vec3 } from "../wire";
import { cellOf, flatOf, isInside, runsOf, UNSEEN } from "./cells";

const COLOUR = "#ff2bd6"; // like no class, no photo and neither theme
const OPACITY = 0.85;

/** The whole step along one axis of the grid that is nearest to a way in the plane of the floor. */
export function stepAlong(x: number, y: number): Vec3 {
  return Math.abs(x) >= Math.abs(y) ? [Math.sign(x) || 1, 0, 0] : [0, Math.sign(y), 0];
}

/** Steps to the right and away from the eye, of a camera at an azimuth. */
export function stepsSeen(azimuth: number): { right: Vec3; away: Vec3 } {
  const right = stepAlong(-Math.sin(azimuth), Math.cos(azimuth));
  return { right, away: [-right[1] || 0, right[0], 0] };
}

export function cursorActions(app: App): void {
  const { actions, store, view } = app;
  let cell: Vec3 | null = null;

  const show = (): void => {
    const { scene, mode, labels } = store.get();
    const shown = cell && scene && mode === "voxels" && isInside(cell, scene.shape);
    view.setOverlay("cursor", shown ? runsOf([flatOf(cell!, scene.shape)]) : null, COLOUR, OPACITY);
    if (!shown) return;
    const label = labels[flatOf(cell!, scene.shape)] ?? UNSEEN;
    store.set({ status: TEXT.cursor(cell!.join(", "), TEXT.classes[label] ?? TEXT.status.unseen) });
  };
  const move = (step: (steps: ReturnType<typeof stepsSeen>) => Vec3): void => {
    const { scene } = store.get();
    if (!scene) return;
    const from = cell && isInside(cell, scene.shape) ? cell : null;
    const way = step(stepsSeen(view.orbit.azimuth));
    const next = from ? (from.map((at, axis) => at + way[axis as 0]) as Vec3) : first(app);
    if (isInside(next, scene.shape)) cell = next;
    show();
  };
  const paint = async (class_id: number): Promise<void> => {
    const { scene, view: look } = store.get();
    if (!scene || !cell) return;
    const cells = runsOf([flatOf(cell, scene.shape)]);
    const verb = class_id ? "paint" : "erase";
    await app.do({ op: "set_cells", cells, class_id, verb, locked: [...look.locked] });
    show();
  };
  const back = (way: Vec3): Vec3 => way.map((value) => -value) as Vec3;
  const noScene = (): string => (store.get().scene ? "" : TEXT.why.noScene);
  const on = (id: string, step: Parameters<typeof move>[0]): void => actions.on(id, { run: () => move(step), why: noScene });
  on("cursor.right", ({ right }) => right);
  on("cursor.left", ({ right }) => back(right));
  on("cursor.away", ({ away }) => away);
  on("cursor.near", ({ away }) => back(away));
  on("cursor.up", () => [0, 0, 1]);
  on("cursor.down", () => [0, 0, -1]);
  const why = (): string => cannotEdit(store) || (cell ? "" : TEXT.why.noCursor);
  actions.on("cursor.paint", { run: () => void paint(store.get().options.classId), why });
  actions.on("cursor.erase", { run: () => void paint(0), why });
  store.watch(["mode"], show);
}

/** Where the cursor begins: in the selection, else what is seen in the middle, else the middle. */
function first({ store, view, canvas }: App): Vec3 {
  const { scene, selectedCells } = store.get();
  const shape = scene?.shape ?? [1, 1, 1];
  const [chosen] = selectedCells;
  if (chosen !== undefined) return cellOf(chosen, shape);
  const hit = view.pick(canvas.clientWidth / 2, canvas.clientHeight / 2);
  return hit ? hit.cell : (shape.map((size) => Math.floor(size / 2)) as Vec3);
}
