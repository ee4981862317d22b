// The bar above: scene, whether it is saved, undo and redo, modes, export, theme, help.

import type { Mode, State } from "../store";
import { TEXT } from "../text";
import { fill, h } from "./dom";
import { exportMenu } from "./export_menu";
import { rove } from "./rove";
import type { App } from "./slots";

export const MODES: readonly Mode[] = ["inspect", "voxels", "objects", "build", "walk"];

export function mountTopBar(host: HTMLElement, app: App): void {
  const { actions, store } = app;
  const name = h("h1", { class: "scene-name" });
  const saved = h("span", { class: "saved" });
  const undo = actions.button("undo", { icon: "undo" });
  const redo = actions.button("redo", { icon: "redo" });
  host.append(
    h(
      "div",
      { class: "top-scene" },
      actions.button("start", { icon: "back" }),
      h("span", { class: "brand", "aria-hidden": "true" }),
      name,
      saved,
      h("div", { class: "top-history" }, undo, redo, actions.button("save", { icon: "save" })),
    ),
    modeTabs(app),
    h(
      "div",
      { class: "top-page" },
      actions.button("palette", { icon: "search" }),
      actions.button("theme", { icon: "sun" }),
      actions.button("help", { icon: "help" }),
      exportMenu(app),
    ),
  );
  store.watch(["scene", "online"], (state) => {
    name.textContent = state.scene?.name ?? TEXT.app;
    name.title = state.scene?.name ?? "";
    showSaved(saved, state);
    document.title = state.scene ? `${state.scene.name} · ${TEXT.app}` : TEXT.app;
  });
}

function showSaved(node: HTMLElement, { scene, online }: Readonly<State>): void {
  node.className = "saved";
  node.title = "";
  if (!online) {
    node.classList.add("is-bad");
    fill(node, TEXT.top.offline);
  } else if (scene?.read_only) {
    node.title = scene.read_only;
    fill(node, TEXT.top.readOnly);
  } else if (scene && !scene.saved) {
    node.classList.add("is-unsaved");
    node.title = TEXT.top.unsavedHint;
    fill(node, TEXT.top.unsaved);
  } else fill(node, scene ? TEXT.top.saved : "");
}

function modeTabs({ actions, store }: App): HTMLElement {
  const tabs = MODES.map((mode, at) => {
    const tab = actions.button(`mode.${mode}`, {
      label: TEXT.action[`mode.${mode}`],
      class: "mode-tab",
    });
    tab.setAttribute("role", "tab");
    tab.removeAttribute("aria-label");
    tab.prepend(h("kbd", { "aria-hidden": "true" }, `⇧${at + 1}`));
    return tab;
  });
  const row = h("div", { class: "mode-tabs", role: "tablist", "aria-label": TEXT.top.modes }, ...tabs);
  rove(row);
  store.watch(["mode"], ({ mode }) => {
    tabs.forEach((tab, at) => tab.setAttribute("aria-selected", String(MODES[at] === mode)));
  });
  return row;
}
