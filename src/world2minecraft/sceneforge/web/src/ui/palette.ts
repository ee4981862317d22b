// All commands by name: type a part of it, Enter does it. What cannot be done now says why.

import type { Binding } from "../keys";
import type { Mode, State } from "../store";
import { TEXT } from "../text";
import { fill, h } from "./dom";
import { shownKey } from "./help";
import { MODES } from "./top_bar";
import type { App } from "./slots";

interface Entry {
  id: string;
  title: string;
  group: string;
  keys: string;
  why: string;
}

export function mountPalette(app: App): { close(): boolean } {
  const input = h("input", {
    type: "text",
    role: "combobox",
    placeholder: TEXT.palette.placeholder,
    "aria-label": TEXT.palette.title,
    "aria-expanded": "true",
    "aria-controls": "palette-list",
    autocomplete: "off",
    spellcheck: "false",
  });
  const list = h("ul", { id: "palette-list", role: "listbox", "aria-label": TEXT.palette.title });
  const box = h("section", { class: "palette", "aria-label": TEXT.palette.title }, input, list);
  box.hidden = true;
  app.stage.parentElement?.append(box);
  let before: HTMLElement | null = null;
  let rows: Entry[] = [];
  let at = 0;

  const draw = (): void => {
    rows = matching(entries(app), input.value);
    at = Math.max(0, Math.min(at, rows.length - 1));
    fill(list, ...rows.map((row, place) => option(row, place === at, () => choose(place))));
    if (!rows.length) list.append(h("li", { class: "note palette-none" }, TEXT.palette.none));
    const chosen = list.children[at];
    chosen?.scrollIntoView({ block: "nearest" });
    input.setAttribute("aria-activedescendant", chosen?.id ?? "");
  };
  const hide = (): boolean => {
    if (box.hidden) return false;
    box.hidden = true;
    (before ?? app.canvas).focus();
    return true;
  };
  const choose = (place: number): void => {
    const row = rows[place];
    if (!row) return;
    hide();
    if (row.why) app.toast(row.why, "error");
    else app.actions.run(row.id);
  };
  input.addEventListener("input", () => {
    at = 0;
    draw();
  });
  input.addEventListener("keydown", (event) => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (event.key === "Enter") choose(at);
    else if (event.key === "Escape") hide();
    else if (step && rows.length) {
      at = (at + step + rows.length) % rows.length;
      draw();
    } else return;
    event.preventDefault();
    event.stopPropagation();
  });
  box.addEventListener("focusout", (event) => {
    if (!box.contains(event.relatedTarget as Node | null)) box.hidden = true;
  });
  app.actions.on("palette", () => {
    if (hide()) return;
    before = document.activeElement as HTMLElement | null;
    box.hidden = false;
    input.value = "";
    at = 0;
    draw();
    input.focus();
  });
  return { close: hide };
}

function entries({ actions, store }: App): Entry[] {
  const state = store.get();
  return actions
    .list()
    .filter(({ binding }) => binding.id !== "palette" && binding.id !== "cancel")
    .map(({ binding, why }) => ({
      id: binding.id,
      title: binding.title,
      group: TEXT.groups[binding.group],
      keys: binding.keys.map(shownKey)[0] ?? "",
      why: whyNotHere(binding, state) || why,
    }));
}

/** Why a command would do nothing in this mode, or changes nothing because it was chosen before. */
function whyNotHere({ id, modes }: Binding, { mode, tool, options }: Readonly<State>): string {
  const words = (some: readonly Mode[]): string => some.map((one) => TEXT.action[`mode.${one}`]).join(", ");
  if (modes && !modes.includes(mode)) {
    const others = MODES.filter((one) => !modes.includes(one));
    return others.length > 1 ? TEXT.why.onlyIn(words(modes)) : TEXT.why.elsewhere(words(others));
  }
  return [`mode.${mode}`, `tool.${tool}`, `class.${options.classId}`].includes(id) ? TEXT.why.chosen : "";
}

/** Those whose words all begin or hold what was typed: what begins with it first, then what can be done. */
function matching(all: Entry[], typed: string): Entry[] {
  const parts = typed.toLowerCase().split(/\s+/).filter(Boolean);
  const found = all.filter(({ title, group }) => parts.every((part) => `${title} ${group}`.toLowerCase().includes(part)));
  const begins = ({ title }: Entry): number => (title.toLowerCase().startsWith(parts[0] ?? "") ? 0 : 1);
  const order = (one: Entry): number => 2 * begins(one) + (one.why ? 1 : 0);
  return found.sort((a, b) => order(a) - order(b));
}

function option(row: Entry, chosen: boolean, choose: () => void): HTMLElement {
  const node = h(
    "li",
    { role: "option", id: `palette-${row.id}`, class: "palette-row", "aria-selected": String(chosen), data: { action: row.id } },
    h("span", { class: "palette-title" }, row.title),
    h("span", { class: "note palette-group" }, row.why || row.group),
    row.keys && h("kbd", { class: "key" }, row.keys),
  );
  if (row.why) node.setAttribute("aria-disabled", "true");
  node.addEventListener("pointerdown", (event) => {
    event.preventDefault();
    choose();
  });
  return node;
}
