// Hangs the editor's own panels, tools and actions into the page.

import { addTool } from "../tools/add";
import { boxTool, lassoTool } from "../tools/region";
import { brushTool } from "../tools/brush";
import { cursorActions } from "../tools/cursor";
import { eyedropperTool } from "../tools/eyedropper";
import { floodTool } from "../tools/flood";
import { ToolManager } from "../tools/manager";
import { measureTool } from "../tools/measure";
import { moveTool } from "../tools/move";
import { pasteActions } from "../tools/paste";
import { navigateTool } from "../tools/navigate";
import type { Press } from "../tools/tool";
import { TEXT } from "../text";
import { cannotEdit } from "./blocked";
import { watchClashes } from "./clashes";
import { cellActions, mountCellSelection } from "./cell_selection";
import { rightClick } from "./context_menu";
import { mountDisplay } from "./display";
import { mountDoubtful } from "./doubtful";
import { mountFloaters } from "./floaters";
import { mountHoles } from "./holes";
import { mountInspector } from "./inspector";
import { mountLegend } from "./legend";
import { objectActions } from "./object_actions";
import { mountObjectList } from "./object_list";
import { mountRecluster } from "./recluster";
import { mountSlices } from "./slices";
import { optionActions, selectionActions } from "./selection_actions";
import { mountSmoothing } from "./smoothing";
import { registerPanel, type App } from "./slots";
import { viewActions } from "./view_actions";

const CHANGING = new Set(["move", "add", "brush", "erase"]); // tools that change the document

export function registerEditing(): void {
  const { titles } = TEXT.panels;
  const right = { place: "right" } as const;
  registerPanel({ id: "legend", title: titles.legend, place: "left", modes: "all", order: 10, mount: mountLegend });
  registerPanel({ id: "objects", title: titles.objects, place: "left", modes: ["inspect", "objects", "build"], order: 20, mount: mountObjectList });
  registerPanel({ ...right, id: "inspector", title: titles.inspector, modes: ["inspect", "objects"], order: 10, mount: mountInspector });
  registerPanel({ ...right, id: "cells", title: titles.cells, modes: ["voxels"], order: 10, mount: mountCellSelection });
  registerPanel({ ...right, id: "floaters", title: titles.floaters, modes: ["voxels"], order: 20, mount: mountFloaters });
  registerPanel({ ...right, id: "holes", title: titles.holes, modes: ["voxels"], order: 30, mount: mountHoles });
  registerPanel({ ...right, id: "smoothing", title: titles.smoothing, modes: ["voxels"], order: 40, closed: true, mount: mountSmoothing });
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
      why: () => (CHANGING.has(tool.id) ? cannotEdit(app.store) : ""),
      active: () => app.store.get().tool === tool.id,
    });
  }
  watchClashes(app);
  viewActions(app);
  objectActions(app);
  cellActions(app);
  pasteActions(desk);
  cursorActions(app);
  selectionActions(app);
  optionActions(app);
  app.store.watch(["mode"], ({ tool }) => {
    if (tool !== "navigate") app.store.set({ tool: "navigate" });
  });
  return manager;
}
