// Hangs the editor's own panels, tools and actions into the page.

import type { Store } from "../store";
import { addTool } from "../tools/add";
import { boxTool, lassoTool } from "../tools/region";
import { brushTool } from "../tools/brush";
import { eyedropperTool } from "../tools/eyedropper";
import { floodTool } from "../tools/flood";
import { ToolManager } from "../tools/manager";
import { measureTool } from "../tools/measure";
import { moveTool } from "../tools/move";
import { navigateTool } from "../tools/navigate";
import { centreAt, objectAt } from "../tools/objects_at";
import type { Press } from "../tools/tool";
import { TEXT } from "../text";
import { cannotEdit } from "./blocked";
import { allCells, cellActions, mountCellSelection } from "./cell_selection";
import { mountDisplay } from "./display";
import { mountDoubtful } from "./doubtful";
import { mountFloaters } from "./floaters";
import { mountHoles } from "./holes";
import { mountInspector } from "./inspector";
import { mountLegend } from "./legend";
import { openMenu } from "./menu";
import { objectActions, selectedOf } from "./object_actions";
import { mountObjectList } from "./object_list";
import { mountRecluster } from "./recluster";
import { mountSlices } from "./slices";
import { registerPanel, type App } from "./slots";
import { viewActions } from "./view_actions";

export function registerEditing(): void {
  const { titles } = TEXT.panels;
  const right = { place: "right" } as const;
  registerPanel({ id: "legend", title: titles.legend, place: "left", modes: "all", order: 10, mount: mountLegend });
  registerPanel({ id: "objects", title: titles.objects, place: "left", modes: ["inspect", "objects", "build"], order: 20, mount: mountObjectList });
  registerPanel({ ...right, id: "inspector", title: titles.inspector, modes: ["inspect", "objects"], order: 10, mount: mountInspector });
  registerPanel({ ...right, id: "cells", title: titles.cells, modes: ["voxels"], order: 10, mount: mountCellSelection });
  registerPanel({ ...right, id: "floaters", title: titles.floaters, modes: ["voxels"], order: 20, mount: mountFloaters });
  registerPanel({ ...right, id: "holes", title: titles.holes, modes: ["voxels"], order: 30, mount: mountHoles });
  registerPanel({ ...right, id: "doubtful", title: titles.doubtful, modes: ["inspect", "objects"], order: 40, closed: true, mount: mountDoubtful });
  registerPanel({ ...right, id: "recluster", title: titles.recluster, modes: ["objects"], order: 50, closed: true, mount: mountRecluster });
  registerPanel({ ...right, id: "slices", title: titles.slices, modes: ["inspect", "voxels", "objects", "build"], order: 80, closed: true, mount: mountSlices });
  registerPanel({ ...right, id: "display", title: titles.display, modes: ["inspect", "voxels", "objects"], order: 90, mount: mountDisplay });
}

/** Make the tools and give the actions what they do; `hover` is told what is under the pointer. */
export function startEditing(app: App, hover: (at: Press | null) => void): ToolManager {
  const manager = new ToolManager(app, { hover, rightClick: (at, event) => rightClick(app, at, event) });
  const { desk } = manager;
  const tools = [
    navigateTool(desk), brushTool(desk, "brush"), brushTool(desk, "erase"), boxTool(desk), lassoTool(desk),
    floodTool(desk), eyedropperTool(desk), measureTool(desk), moveTool(desk), addTool(desk),
  ]; // prettier-ignore
  for (const tool of tools) {
    manager.add(tool);
    app.actions.on(`tool.${tool.id}`, {
      run: () => app.store.set({ tool: tool.id }),
      why: () => (tool.id === "move" || tool.id === "add" || tool.id === "brush" || tool.id === "erase" ? cannotEdit(app.store) : ""),
      active: () => app.store.get().tool === tool.id,
    });
  }
  const { selection } = desk;
  viewActions(app);
  objectActions(app, selection);
  cellActions(app, selection);
  selectionActions(app, manager);
  optionActions(app);
  app.store.watch(["mode"], () => {
    const inMode = app.store.get();
    if (inMode.tool !== "navigate") app.store.set({ tool: "navigate" });
  });
  return manager;
}

function selectionActions(app: App, { desk }: ToolManager): void {
  const { actions, store } = app;
  const { selection } = desk;
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
  actions.on("select.all", () => {
    if (inObjects()) selection.objects(store.get().objects.keys());
    else selection.cells(allCells(app));
  });
  actions.on("select.none", () => selection.clear());
  actions.on("select.invert", () => {
    const { objects, selectedObjects, selectedCells } = store.get();
    if (inObjects()) selection.objects([...objects.keys()].filter((id) => !selectedObjects.has(id)));
    else selection.cells(allCells(app).filter((flat) => !selectedCells.has(flat)));
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

function optionActions({ actions, store }: App): void {
  const sized = (by: number): void => {
    const { size } = store.get().options;
    store.setOptions({ size: Math.min(15, Math.max(1, size + by)) });
  };
  actions.on("brush.smaller", () => sized(-1));
  actions.on("brush.larger", () => sized(1));
  actions.on("brush.shape", () => {
    const shapes = ["sphere", "cube", "single"] as const;
    const at = shapes.indexOf(store.get().options.shape);
    store.setOptions({ shape: shapes[(at + 1) % 3] ?? "sphere" });
  });
  actions.on("surface", () => store.setOptions({ surfaceOnly: !store.get().options.surfaceOnly }));
  for (let id = 0; id < 12; id++) actions.on(`class.${id}`, () => store.setOptions({ classId: id }));
}

/** On a centre it deletes, as in the paper's tool; elsewhere it offers what can be done there. */
function rightClick(app: App, at: Press, event: PointerEvent): void {
  const { mode } = app.store.get();
  if (mode === "walk" || mode === "build") return;
  const centre = mode === "objects" ? centreAt(app, at.x, at.y) : null;
  if (centre) {
    const why = cannotEdit(app.store);
    if (why) app.toast(why, "error");
    else void app.do({ op: "delete_objects", ids: [centre.id] });
    return;
  }
  openMenu(placeMenu(app, at), event.clientX, event.clientY);
}

function placeMenu(app: App, at: Press): MenuItem[] {
  const { store, actions } = app;
  const hit = app.view.pick(at.x, at.y);
  const one = objectAt(app, at.x, at.y);
  const label = hit ? (store.get().labels[hit.flat] ?? 0) : 0;
  const word = TEXT.classes[label] ?? "";
  const nothing = hit ? "" : TEXT.why.noPlace;
  const select = (): void => void (one && store.set({ selectedObjects: new Set([one.id]) }));
  return [
    ...(one ? [{ label: TEXT.context.select(TEXT.classes[one.class_id] ?? "", one.id), run: select }] : []),
    { label: TEXT.context.focus, hint: "F", why: nothing, run: () => hit && focusCells(app, [hit.flat]) },
    { label: TEXT.context.hide(word), hint: "\\", why: nothing, run: () => toggleSeen(app, label, false) },
    { label: TEXT.context.take(word), hint: "I", why: nothing, run: () => store.setOptions({ classId: label }) },
    {
      label: TEXT.context.component,
      hint: "Shift+Delete",
      why: nothing || cannotEdit(store),
      danger: true,
      run: () => hit && void app.do({ op: "delete_component", cell: hit.cell, locked: [...store.get().view.locked] }),
    },
    { label: TEXT.action["view.reset"], hint: "Shift+F", run: () => actions.run("view.reset") },
  ];
}
