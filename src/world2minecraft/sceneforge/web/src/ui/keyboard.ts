// Listens to keys and does what the table of keys.ts says.

import { bindingFor } from "../keys";
import type { Actions } from "./actions";
import type { Store } from "../store";
import { takesText } from "./dom";

const WHILE_TYPING = new Set(["undo", "redo", "delete", "select.all"]); // The field has its own.

export function listenToKeys(store: Store, actions: Actions): void {
  window.addEventListener("keydown", (event) => {
    if (event.defaultPrevented) return;
    const binding = bindingFor(event, store.get().mode);
    if (!binding || !actions.has(binding.id)) return;
    const chord = event.ctrlKey || event.metaKey || event.key === "Escape" || event.key === "F1";
    if (takesText(event.target) && (!chord || WHILE_TYPING.has(binding.id))) return;
    if (usesItself(event)) return;
    event.preventDefault();
    actions.run(binding.id);
  });
}

/** Enter on a button presses it, arrows move a slider: they are no commands then. */
function usesItself(event: KeyboardEvent): boolean {
  const target = event.target;
  if (!(target instanceof HTMLElement) || target instanceof HTMLCanvasElement) return false;
  if (event.key === " ") return target.closest("button, a, input, select, summary, [role=treeitem], [role=tab]") !== null;
  if (event.key === "Enter") return target.closest("button, a, select, summary, [role=treeitem]") !== null;
  if (event.key.startsWith("Page")) return target.closest("input, select") !== null;
  if (event.key.startsWith("Arrow")) {
    return target.closest("input, select, [role=treeitem], [role=tablist]") !== null;
  }
  return target instanceof HTMLSelectElement && event.key.length === 1 && !event.ctrlKey;
}
