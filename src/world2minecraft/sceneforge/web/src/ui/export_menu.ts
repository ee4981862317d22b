// The export menu: what others registered, and saving.

import { TEXT } from "../text";
import { icon } from "./icons";
import { menuButton } from "./menu";
import { slots, type App } from "./slots";

export function exportMenu(app: App): HTMLElement {
  const node = menuButton(
    { label: TEXT.action.export, class: "button is-main", id: "export" },
    () => [
      { label: TEXT.action.save, hint: "Ctrl+S", why: app.actions.why("save"), run: () => app.actions.run("save") },
      ...slots.exports().map((item) => ({
        label: item.label,
        hint: item.hint,
        why: item.why?.(app) ?? "",
        run: () => item.run(app),
      })),
    ],
  );
  node.prepend(icon("export"));
  app.actions.on("export", { run: () => node.click(), why: () => (app.store.get().scene ? "" : TEXT.why.noScene) });
  return node;
}
