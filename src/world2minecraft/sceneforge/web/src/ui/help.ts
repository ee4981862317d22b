// The help page: the one table of keys and gestures, drawn from what listens to them.

import { BINDINGS, GROUPS, type Binding } from "../keys";
import { TEXT } from "../text";
import { h } from "./dom";
import { icon } from "./icons";
import type { App } from "./slots";

export function mountHelp(app: App): { close(): boolean } {
  const close = h("button", { type: "button", class: "button icon-only", "aria-label": TEXT.help.close });
  close.append(icon("close"));
  close.title = TEXT.help.close;
  const groups = GROUPS.map((group) => section(group, BINDINGS.filter((one) => one.group === group && one.keys.length)));
  const page = h(
    "section",
    { class: "sheet help", role: "region", "aria-label": TEXT.help.title, tabindex: "-1" },
    h("div", { class: "sheet-head" }, h("h2", {}, TEXT.help.title), h("span", { class: "note" }, TEXT.help.note), close),
    h("div", { class: "help-groups" }, ...groups.filter((one) => one !== null)),
  );
  page.hidden = true;
  app.stage.append(page);
  let before: HTMLElement | null = null;
  const hide = (): boolean => {
    if (page.hidden) return false;
    page.hidden = true;
    (before ?? app.canvas).focus();
    return true;
  };
  close.addEventListener("click", hide);
  app.actions.on("help", () => {
    if (hide()) return;
    before = document.activeElement as HTMLElement | null;
    page.hidden = false;
    page.focus();
  });
  return { close: hide };
}

function section(group: (typeof GROUPS)[number], lines: readonly Binding[]): HTMLElement | null {
  if (!lines.length) return null;
  const rows = lines.flatMap((one) => [
    h("dt", {}, ...one.keys.map((key) => h("kbd", { class: "key" }, shownKey(key)))),
    h("dd", {}, one.title, one.modes && one.modes.length < 3 && !SAID.has(group) && h("span", { class: "note" }, ` ${one.modes.map((mode) => TEXT.action[`mode.${mode}`]).join(", ")}`)),
  ]);
  return h("section", { class: "help-group" }, h("h3", {}, TEXT.groups[group]), h("dl", {}, ...rows));
}

const SAID = new Set(["voxels", "objects", "selection", "classes"]); // groups that say their modes

const SHOWN: Record<string, string> = { Escape: "Esc", ArrowRight: "→", ArrowLeft: "←", ArrowUp: "↑", ArrowDown: "↓", PageUp: "Page up", PageDown: "Page down" };

export function shownKey(key: string): string {
  return key
    .split("+")
    .map((part) => SHOWN[part] ?? part.replace(/^Numpad/, "Numpad "))
    .join("+");
}
