// Panels of the sides: sections that fold, shown in the modes that they belong to. And the drawer
// below the scene: tabs over one panel at a time.

import { TEXT } from "../text";
import { h } from "./dom";
import { icon } from "./icons";
import { rove } from "./rove";
import { slots, type App, type Panel } from "./slots";

const MEMORY = "sceneforge.panels"; // which are folded, for this browser

export function mountSide(host: HTMLElement, place: "left" | "right", app: App): void {
  for (const panel of slots.panels(place)) host.append(section(panel, app));
}

function section(panel: Panel, app: App): HTMLElement {
  const body = h("div", { class: "panel-body", id: `panel-${panel.id}` });
  const toggle = h(
    "button",
    { type: "button", class: "panel-title", "aria-controls": body.id },
    h("span", {}, panel.title),
    icon("down"),
  );
  const node = h("section", { class: "panel", data: { panel: panel.id } }, h("h2", {}, toggle), body);
  let open = remembered()[panel.id] ?? !panel.closed;
  const show = (): void => {
    toggle.setAttribute("aria-expanded", String(open));
    body.hidden = !open;
  };
  toggle.addEventListener("click", () => {
    open = !open;
    remember(panel.id, open);
    show();
  });
  show();
  panel.mount(body, app);
  app.store.watch(["mode"], ({ mode }) => {
    node.hidden = panel.modes !== "all" && !panel.modes.includes(mode);
  });
  return node;
}

/** Open a folded panel that a key asked for, and bring it into view. */
export function unfold(id: string): void {
  const node = document.querySelector<HTMLElement>(`[data-panel="${id}"]`);
  const toggle = node?.querySelector<HTMLElement>(".panel-title");
  if (toggle?.getAttribute("aria-expanded") === "false") toggle.click();
  node?.scrollIntoView({ block: "nearest" });
}

export function mountDrawer(host: HTMLElement, app: App): void {
  const panels = slots.panels("drawer");
  const tabs = h("div", { class: "drawer-tabs", role: "tablist", "aria-label": TEXT.panels.drawer });
  const bodies = h("div", { class: "drawer-bodies" });
  let chosen: string | null = null;
  const entries = panels.map((panel) => {
    const id = `drawer-${panel.id}`;
    const tab = h("button", { type: "button", role: "tab", class: "drawer-tab", "aria-controls": id });
    tab.append(panel.title);
    const body = h("div", { id, role: "tabpanel", class: "drawer-body" });
    panel.mount(body, app);
    tab.addEventListener("click", () => {
      chosen = chosen === panel.id ? null : panel.id;
      show();
    });
    tabs.append(tab);
    bodies.append(body);
    return { panel, tab, body };
  });
  const show = (): void => {
    const { mode } = app.store.get();
    for (const { panel, tab, body } of entries) {
      const here = panel.modes === "all" || panel.modes.includes(mode);
      tab.hidden = !here;
      tab.setAttribute("aria-selected", String(here && chosen === panel.id));
      body.hidden = !here || chosen !== panel.id;
    }
    host.hidden = entries.every(({ tab }) => tab.hidden);
  };
  rove(tabs);
  host.append(tabs, bodies);
  app.store.watch(["mode"], show);
}

function remembered(): Record<string, boolean> {
  try {
    return JSON.parse(localStorage.getItem(MEMORY) ?? "{}") as Record<string, boolean>;
  } catch {
    return {};
  }
}

function remember(id: string, open: boolean): void {
  localStorage.setItem(MEMORY, JSON.stringify({ ...remembered(), [id]: open }));
}
