// The cells that are selected: how many of what, and what can be done with them.

import type { Store } from "../store";
import { TEXT } from "../text";
import { boundsOf, cellOf, runsOf } from "../tools/cells";
import type { Vec3 } from "../wire";
import { cannotEdit } from "./blocked";
import { fill, h } from "./dom";
import type { App } from "./slots";

export function mountCellSelection(host: HTMLElement, app: App): void {
  const { actions, store } = app;
  const told = h("div", { "aria-live": "polite" });
  const give = actions.button("cells.relabel", { label: TEXT.cellsPanel.relabel });
  const buttons = h(
    "div",
    { class: "stack" },
    give,
    h("div", { class: "row is-even" }, actions.button("cells.fillBox", { label: TEXT.cellsPanel.fillBox }), actions.button("cells.smooth", { label: TEXT.cellsPanel.smooth })),
    h("div", { class: "row is-even" }, actions.button("select.none", { label: TEXT.cellsPanel.none }), actions.button("delete", { icon: "trash", label: TEXT.cellsPanel.remove, class: "button is-danger" })),
  );
  host.append(h("div", { class: "stack" }, told, buttons));
  store.watch(["selectedCells", "scene", "options"], ({ selectedCells, options }) => {
    const label = give.querySelector("span");
    if (label) label.textContent = TEXT.cellsPanel.give(TEXT.classes[options.classId] ?? "");
    fill(told, selectedCells.size ? chips(store) : h("p", { class: "note" }, TEXT.cellsPanel.empty));
    buttons.hidden = !selectedCells.size;
  });
}

function chips(store: Store): HTMLElement {
  const { selectedCells, labels, scene } = store.get();
  const counts = new Map<number, number>();
  for (const flat of selectedCells) {
    const label = labels[flat] ?? 255;
    counts.set(label, (counts.get(label) ?? 0) + 1);
  }
  const rows = [...counts].sort((a, b) => b[1] - a[1]).map(([id, count]) =>
    h(
      "span",
      { class: "chip" },
      h("span", { class: "swatch", vars: { "--swatch": `rgb(${(scene?.classes[id]?.colour ?? [128, 128, 128]).join(" ")})` } }),
      TEXT.cellsPanel.chip(TEXT.classes[id] ?? TEXT.status.unseen, TEXT.cells(count)),
    ),
  );
  return h("div", { class: "stack" }, h("strong", {}, TEXT.cells(selectedCells.size)), h("div", { class: "chips" }, ...rows));
}

export function cellActions(app: App): void {
  const { actions, store, view, selection } = app;
  const none = (): string => (store.get().selectedCells.size ? "" : TEXT.why.noCells);
  const why = (): string => cannotEdit(store) || none();
  const held = (): object => ({ cells: runsOf(store.get().selectedCells), locked: [...store.get().view.locked] });
  actions.on("cells.relabel", {
    run: () => void app.do({ op: "set_cells", ...held(), class_id: store.get().options.classId, verb: "relabel" }),
    why: () => why() || (store.get().options.classId ? "" : TEXT.why.emptyClass),
  });
  actions.on("cells.fillBox", {
    run: () => {
      const { scene, selectedCells, options, view: look } = store.get();
      const box = scene && boundsOf(selectedCells, scene.shape);
      if (box) void app.do({ op: "fill_box", ...box, class_id: options.classId, locked: [...look.locked] });
    },
    why: () => why() || (store.get().options.classId ? "" : TEXT.why.emptyClass),
  });
  actions.on("cells.smooth", {
    run: () => {
      const { selectedCells } = store.get();
      void app.do({ op: "smooth", ...(selectedCells.size ? { runs: runsOf(selectedCells) } : {}) });
    },
    why: () => cannotEdit(store),
  });
  actions.on("cells.component", {
    run: () => {
      const at = app.pointer.at;
      const hit = at && view.pick(at.x, at.y);
      if (hit) void app.do({ op: "delete_component", cell: hit.cell, locked: [...store.get().view.locked] });
      else app.toast(TEXT.why.noPlace, "error");
    },
    why: () => cannotEdit(store) || (app.pointer.at ? "" : TEXT.why.noPlace),
  });
  store.watch(["selectedCells", "scene"], ({ selectedCells }) =>
    view.setOverlay("selection", selectedCells.size ? runsOf(selectedCells) : null, SELECTED),
  );
  // Cells that are empty now are selected no longer: nothing could be seen of them.
  app.connection.onChange(() => {
    const { selectedCells, labels } = store.get();
    const left = [...selectedCells].filter((flat) => (labels[flat] ?? 255) % 255 !== 0);
    if (left.length < selectedCells.size) selection.cells(left);
  });
}

const SELECTED = "#ffd9a0";

export function allCells({ store }: App): number[] {
  const { labels, scene, view } = store.get();
  const found: number[] = [];
  labels.forEach((label, flat) => {
    if (label % 255 === 0) return;
    const hidden = view.solo === null ? view.hidden.has(label) : view.solo !== label;
    if (!hidden && scene && isShown(cellOf(flat, scene.shape), view)) found.push(flat);
  });
  return found;
}

function isShown(cell: Vec3, { slice, section }: ReturnType<Store["get"]>["view"]): boolean {
  if (slice && ((cell[slice.axis] ?? 0) < slice.low || (cell[slice.axis] ?? 0) > slice.high)) return false;
  return !section || cell.every((at, axis) => at >= section.low[axis as 0] && at <= section.high[axis as 0]);
}
