// Small regions that hang alone: listed by size, shown, deleted all at once or one by one.

import type { Run, Vec3 } from "../wire";
import { TEXT } from "../text";
import { cellsOfRuns, cellOf } from "../tools/cells";
import { cannotEdit } from "./blocked";
import { fill, h, setWhy } from "./dom";
import { plainButton, slider } from "./fields";
import { unfold } from "./panels";
import { rove } from "./rove";
import type { App } from "./slots";

interface Floater {
  cells: number;
  runs: Run[];
  class_id: number;
  at_m: Vec3;
}

const FOUND = "#ff5252";
const MOST_ROWS = 60;

export function mountFloaters(host: HTMLElement, app: App): void {
  let most = 40;
  let found: Floater[] = [];
  let looked = false;
  const list = h("div", { class: "found-list", role: "group", "aria-label": TEXT.floaters.title });
  const note = h("p", { class: "note", "aria-live": "polite" }, TEXT.floaters.note);
  const show = (some: readonly Floater[]): void =>
    app.view.setOverlay("floaters", some.length ? some.flatMap((one) => one.runs) : null, FOUND);
  const draw = (): void => {
    show(found);
    note.textContent = looked ? TEXT.floaters.found(found.length, total(found)) : TEXT.floaters.note;
    fill(list, ...found.slice(0, MOST_ROWS).map((one) => row(app, one, () => show([one]), () => show(found))));
    setWhy(all, cannotEdit(app.store) || (found.length ? "" : TEXT.why.noFloaters), TEXT.floaters.deleteAll);
  };
  const look = async (): Promise<void> => {
    looked = true;
    found = (await app.ask<Floater[]>("floaters", { max_cells: most })) ?? [];
    draw();
  };
  const clear = (): void => {
    looked = false;
    found = [];
    draw();
  };
  const size = slider({
    label: TEXT.floaters.size,
    id: "floater-size",
    min: 1,
    max: 400,
    step: 1,
    show: TEXT.cells,
    change: (value) => {
      most = value;
      if (looked) void look();
    },
  });
  size.set(most);
  const find = plainButton(TEXT.floaters.find, () => void look());
  const all = plainButton(TEXT.floaters.deleteAll, () => void app.do({ op: "remove_floaters", max_cells: most }), "button is-danger");
  find.dataset.do = "find-floaters";
  all.dataset.do = "delete-floaters";
  host.append(h("div", { class: "stack" }, size.node, h("div", { class: "row is-even" }, find, all), note, list));
  rove(list);
  draw();
  app.actions.on("floaters.find", { run: () => {
      unfold("floaters");
      void look();
    }, why: () => (app.store.get().scene ? "" : TEXT.why.noScene) });
  app.store.watch(["online", "scene"], draw);
  app.connection.onChange(() => looked && void look());
  app.store.watch(["mode"], ({ mode }) => mode !== "voxels" && looked && clear());
}

function row(app: App, one: Floater, over: () => void, out: () => void): HTMLElement {
  const colour = app.store.get().scene?.classes[one.class_id]?.colour ?? [128, 128, 128];
  const node = h(
    "button",
    { type: "button", class: "found", title: TEXT.floaters.select },
    h("span", { class: "swatch", vars: { "--swatch": `rgb(${colour.join(" ")})` } }),
    h("span", { class: "tree-word" }, TEXT.classes[one.class_id]),
    h("span", { class: "legend-count" }, TEXT.cells(one.cells)),
  );
  for (const kind of ["pointerenter", "focus"]) node.addEventListener(kind, over);
  for (const kind of ["pointerleave", "blur"]) node.addEventListener(kind, out);
  node.addEventListener("click", () => {
    const { scene } = app.store.get();
    const flats = cellsOfRuns(one.runs);
    app.store.set({ selectedCells: new Set(flats) });
    if (scene) focusCells(app, flats);
  });
  return node;
}

export function focusCells({ store, view }: App, flats: readonly number[]): void {
  const { scene } = store.get();
  if (!scene || !flats.length) return;
  const cells = flats.map((flat) => cellOf(flat, scene.shape));
  const side = (axis: 0 | 1 | 2, end: number, of: (...values: number[]) => number): number =>
    scene.origin_m[axis] + (cells.reduce((best, cell) => of(best, cell[axis]), cells[0]?.[axis] ?? 0) + end) * scene.voxel_m;
  const low: Vec3 = [side(0, 0, Math.min), side(1, 0, Math.min), side(2, 0, Math.min)];
  const high: Vec3 = [side(0, 1, Math.max), side(1, 1, Math.max), side(2, 1, Math.max)];
  view.focus({ low, high });
}

function total(found: readonly Floater[]): number {
  return found.reduce((sum, one) => sum + one.cells, 0);
}
