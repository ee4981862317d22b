// Takes the class of what is clicked, and gives the tool before it back.

import type { Desk, Tool } from "./tool";

export function eyedropperTool(desk: Desk): Tool {
  const { store, view } = desk.app;
  let before = "navigate";
  store.watch(["tool"], ({ tool }) => {
    if (tool !== "eyedropper") before = tool;
  });
  return {
    id: "eyedropper",
    cursor: "copy",
    press: (at) => {
      const hit = view.pick(at.x, at.y);
      return {
        move: () => undefined,
        end: () => {
          const label = hit ? store.get().labels[hit.flat] : undefined;
          if (label !== undefined && label < 12) store.setOptions({ classId: label });
          store.set({ tool: before });
        },
        cancel: () => undefined,
      };
    },
  };
}
