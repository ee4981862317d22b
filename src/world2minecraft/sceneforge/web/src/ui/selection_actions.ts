// Actions on what is selected, whatever it is, and on the options of tools.

import { runsOf } from "../tools/cells";
import { TEXT } from "../text";
import { cannotEdit } from "./blocked";
import { allCells } from "./cell_selection";
import { selectedOf } from "./object_actions";
import type { App } from "./slots";

const LARGEST_BRUSH = 15; // cells

export function selectionActions(app: App): void {
  const { actions, store, selection } = app;
  const inObjects = (): boolean => store.get().mode === "objects";
  actions.on("delete", {
    run: () => {
      const ids = selectedOf(app).map(({ id }) => id);
      if (inObjects() || store.get().mode === "inspect") void app.do({ op: "delete_objects", ids });
      else deleteCells(app);
    },
    why: () =>
      cannotEdit(store) ||
      (store.get().mode === "voxels"
        ? store.get().selectedCells.size ? "" : TEXT.why.noCells
        : selectedOf(app).length ? "" : TEXT.why.noObject),
  });
  const noObjects = (): string => (inObjects() && !store.get().objects.size ? TEXT.why.noObjects("") : "");
  actions.on("select.all", {
    run: () => {
      if (inObjects()) selection.objects(store.get().objects.keys());
      else selection.cells(allCells(app));
    },
    why: noObjects,
  });
  actions.on("select.none", {
    run: () => selection.clear(),
    why: () => (store.get().selectedCells.size + store.get().selectedObjects.size ? "" : TEXT.why.nothingSelected),
  });
  actions.on("select.invert", {
    run: () => {
      const { objects, selectedObjects, selectedCells } = store.get();
      if (inObjects()) selection.objects([...objects.keys()].filter((id) => !selectedObjects.has(id)));
      else selection.cells(allCells(app).filter((flat) => !selectedCells.has(flat)));
    },
    why: noObjects,
  });
  actions.on("select.undo", {
    run: () => selection.undo(),
    why: () => (selection.canUndo ? "" : TEXT.why.noSelectionBefore),
  });
  actions.on("select.redo", {
    run: () => selection.redo(),
    why: () => (selection.canRedo ? "" : TEXT.why.noSelectionAfter),
  });
}

function deleteCells({ store, do: send }: App): void {
  const { selectedCells, view } = store.get();
  void send({ op: "set_cells", cells: runsOf(selectedCells), class_id: 0, verb: "delete", locked: [...view.locked] });
}

export function optionActions({ actions, store }: App): void {
  const size = (): number => store.get().options.size;
  actions.on("brush.smaller", {
    run: () => store.setOptions({ size: size() - 1 }),
    why: () => (size() > 1 ? "" : TEXT.why.smallest),
  });
  actions.on("brush.larger", {
    run: () => store.setOptions({ size: size() + 1 }),
    why: () => (size() < LARGEST_BRUSH ? "" : TEXT.why.largest),
  });
  actions.on("brush.shape", () => {
    const shapes = ["sphere", "cube", "single"] as const;
    const at = shapes.indexOf(store.get().options.shape);
    store.setOptions({ shape: shapes[(at + 1) % 3] ?? "sphere" });
  });
  actions.on("surface", () => store.setOptions({ surfaceOnly: !store.get().options.surfaceOnly }));
  for (let id = 0; id < 12; id++) actions.on(`class.${id}`, () => store.setOptions({ classId: id }));
}
