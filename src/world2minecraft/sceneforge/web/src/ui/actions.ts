// What a person can have done: one name for the key, the button and the line of the palette.

import { BINDINGS, type Binding, bindingOf } from "../keys";
import type { Store } from "../store";
import { TEXT } from "../text";
import { h, setWhy } from "./dom";
import { icon, type IconName } from "./icons";

export interface Action {
  run(): void;
  why?(): string; // why it cannot be done now; empty where it can
  title?(): string; // what it would do now, where that changes
  active?(): boolean; // for what is switched on and off, or chosen
}

export class Actions {
  private actions = new Map<string, Action>();
  private buttons = new Set<{ node: WeakRef<HTMLElement>; id: string }>();
  private due = false;

  constructor(
    store: Store,
    private refuse: (why: string) => void,
  ) {
    const keys = ["scene", "objects", "selectedObjects", "selectedCells"] as const;
    store.watch([...keys, "mode", "tool", "view", "options", "online", "theme"], () =>
      this.refresh(),
    );
  }

  /** Give a line of the key table what it does. */
  on(id: string, action: Action | (() => void)): void {
    this.actions.set(id, typeof action === "function" ? { run: action } : action);
  }

  has(id: string): boolean {
    return this.actions.has(id);
  }

  why(id: string): string {
    const action = this.actions.get(id);
    return action ? (action.why?.() ?? "") : TEXT.why.notHere;
  }

  active(id: string): boolean {
    return this.actions.get(id)?.active?.() ?? false;
  }

  run(id: string): void {
    const why = this.why(id);
    if (why) this.refuse(why);
    else this.actions.get(id)?.run();
  }

  /** All that can be asked for by name, with the reason where it cannot be done now. */
  list(): { binding: Binding; why: string }[] {
    return BINDINGS.filter((one) => this.has(one.id)).map((binding) => ({
      binding,
      why: this.why(binding.id),
    }));
  }

  /** A button that does an action, shows its key, and says why it cannot where it cannot. */
  button(id: string, look: { icon?: IconName; label?: string; class?: string } = {}): HTMLElement {
    const label = look.label ?? (look.icon ? "" : titleOf(id));
    const node = h(
      "button",
      {
        type: "button",
        class: look.class ?? (label ? "button" : "button icon-only"),
        data: { action: id },
        "aria-label": label ? undefined : titleOf(id), // What is read is what is seen.
        on: { click: () => this.run(id) },
      },
      look.icon && icon(look.icon),
      label && h("span", {}, label),
    );
    this.buttons.add({ node: new WeakRef(node), id });
    this.show(node, id);
    return node;
  }

  /** Look again which buttons can be used; done by itself after changes of the store. */
  refresh(): void {
    if (this.due) return;
    this.due = true;
    requestAnimationFrame(() => {
      this.due = false;
      for (const entry of this.buttons) {
        const node = entry.node.deref();
        if (node) this.show(node, entry.id);
        else this.buttons.delete(entry);
      }
    });
  }

  private show(node: HTMLElement, id: string): void {
    const keys = bindingOf(id)?.keys[0];
    const action = this.actions.get(id);
    const title = action?.title?.() ?? titleOf(id);
    setWhy(node, this.why(id), keys ? `${title} (${keys})` : title);
    if (action?.title) node.setAttribute("aria-label", title);
    if (action?.active) {
      node.setAttribute("aria-pressed", String(this.active(id)));
    }
  }
}

export function titleOf(id: string): string {
  return bindingOf(id)?.title ?? id;
}
