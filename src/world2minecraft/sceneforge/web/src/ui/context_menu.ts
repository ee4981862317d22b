// A right click on the scene.

import { centreAt, objectAt } from "../tools/objects_at";
import type { Press } from "../tools/tool";
import { TEXT } from "../text";
import { cannotEdit } from "./blocked";
import { focusCells } from "./floaters";
import { toggleSeen } from "./legend";
import { openMenu, type MenuItem } from "./menu";
import type { App } from "./slots";

/** On a centre it deletes, as in the paper's tool; elsewhere it offers what can be done there. */
export function rightClick(app: App, at: Press, event: PointerEvent): void {
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
    ...(one ? [{ label: TEXT.context.select(one.title, one.id), run: select }] : []),
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
