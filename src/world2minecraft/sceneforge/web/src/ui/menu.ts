// Small menus that hang below a button or at the pointer. Nothing behind them is blocked.

import { h } from "./dom";
import { rove } from "./rove";

export interface MenuItem {
  label: string;
  hint?: string | undefined;
  why?: string; // why it cannot be chosen
  swatch?: string; // a colour beside the label
  danger?: boolean;
  run(): void;
}

let shown: { node: HTMLElement; owner: HTMLElement | null } | null = null;

export function menuButton(
  look: { label: string; class: string; id: string; title?: string },
  items: () => MenuItem[],
): HTMLButtonElement {
  const node = h(
    "button",
    {
      type: "button",
      class: look.class,
      "aria-haspopup": "menu",
      "aria-expanded": "false",
      title: look.title ?? look.label,
      data: { menu: look.id },
    },
    look.label,
  );
  node.addEventListener("click", () => {
    if (shown?.owner === node) closeMenu();
    else {
      const box = node.getBoundingClientRect();
      openMenu(items(), box.left, box.bottom + 4, node, box.right);
    }
  });
  return node;
}

/** Open a menu at a point of the page; `right` is the edge to align with where space is short. */
export function openMenu(
  items: readonly MenuItem[],
  x: number,
  y: number,
  owner: HTMLElement | null = null,
  right = x,
): void {
  closeMenu();
  const node = h("div", { class: "menu", role: "menu" }, ...items.map(itemNode));
  document.body.append(node);
  const { width, height } = node.getBoundingClientRect();
  const left = x + width > innerWidth - 8 ? Math.max(8, Math.min(right, innerWidth - 8) - width) : x;
  const top = y + height > innerHeight - 8 ? Math.max(8, innerHeight - 8 - height) : y;
  node.style.left = `${left}px`;
  node.style.top = `${top}px`;
  rove(node, "[role=menuitem]");
  owner?.setAttribute("aria-expanded", "true");
  shown = { node, owner };
  node.querySelector<HTMLElement>("[role=menuitem]")?.focus();
  addEventListener("pointerdown", outside, true);
}

/** Close the menu that is open; whether there was one. */
export function closeMenu(): boolean {
  if (!shown) return false;
  const { node, owner } = shown;
  shown = null;
  removeEventListener("pointerdown", outside, true);
  const held = node.contains(document.activeElement);
  node.remove();
  owner?.setAttribute("aria-expanded", "false");
  if (held) (owner ?? document.querySelector<HTMLElement>(".canvas"))?.focus();
  return true;
}

function outside(event: Event): void {
  const target = event.target as Node;
  if (!shown?.node.contains(target) && !shown?.owner?.contains(target)) closeMenu();
}

function itemNode(item: MenuItem): HTMLElement {
  const node = h(
    "button",
    { type: "button", role: "menuitem", class: item.danger ? "menu-item is-danger" : "menu-item" },
    item.swatch && h("span", { class: "swatch", vars: { "--swatch": item.swatch } }),
    h("span", { class: "menu-label" }, item.label),
    item.hint && h("span", { class: "menu-hint" }, item.hint),
  );
  if (item.why) {
    node.setAttribute("aria-disabled", "true");
    node.setAttribute("aria-description", item.why);
    node.title = item.why;
  }
  node.addEventListener("click", () => {
    if (item.why) return;
    closeMenu();
    item.run();
  });
  return node;
}
