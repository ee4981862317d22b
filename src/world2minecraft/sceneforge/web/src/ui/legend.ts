// The twelve classes: colour, key, name, count, whether they are seen, whether they are locked.
// A click chooses the class that tools paint and add.

import type { State } from "../store";
import { TEXT } from "../text";
import { fill, h } from "./dom";
import { classMenu } from "./class_menu";
import { icon } from "./icons";
import { rove } from "./rove";
import type { App } from "./slots";

const COLUMNS = 4; // buttons of a row: class, more, lock, eye

export function mountLegend(host: HTMLElement, app: App): void {
  const rows = h("div", { class: "legend", role: "group", "aria-label": TEXT.legend.title });
  host.append(rows);
  rove(rows, "button", COLUMNS);
  const parts = new Map<number, Row>();
  app.store.watch(["scene", "view", "options"], (state) => {
    if (!state.scene) return;
    for (const { id, colour } of state.scene.classes) {
      if (!parts.has(id)) {
        const row = makeRow(app, id, `rgb(${colour.join(" ")})`);
        parts.set(id, row);
        // What is painted first is seen first: classes by their ids, empty last.
        if (id) rows.insertBefore(row.node, parts.get(0)?.node ?? null);
        else rows.append(row.node);
      }
    }
    for (const [id, row] of parts) showRow(row, id, state);
  });
}

interface Row {
  node: HTMLElement;
  name: HTMLElement;
  count: HTMLElement;
  eye: HTMLElement;
  lock: HTMLElement;
}

function makeRow(app: App, id: number, colour: string): Row {
  const { store } = app;
  const word = TEXT.classes[id] ?? String(id);
  const count = h("span", { class: "legend-count" });
  const name = h(
    "button",
    { type: "button", class: "legend-name", on: { click: () => store.setOptions({ classId: id }) } },
    h("span", { class: "swatch", vars: { "--swatch": colour } }),
    h("span", { class: "legend-word" }, word),
    count,
    h("kbd", { class: "legend-key" }, keyOf(id)),
  );
  const eye = h("button", { type: "button", class: "mini" });
  const lock = h("button", { type: "button", class: "mini" });
  const more = h("button", { type: "button", class: "mini", "aria-haspopup": "menu" }, icon("more"));
  more.title = TEXT.legend.more(word);
  more.setAttribute("aria-label", more.title);
  eye.addEventListener("click", (event) => toggleSeen(app, id, event.altKey));
  lock.addEventListener("click", () => toggleLock(app, id));
  more.addEventListener("click", () => classMenu(app, id, more));
  const node = h("div", { class: "legend-row", data: { class: String(id) } }, name, more, lock, eye);
  if (!id) for (const one of [eye, lock, more]) one.style.visibility = "hidden";
  return { node, name, count, eye, lock };
}

function showRow(row: Row, id: number, { scene, view, options }: Readonly<State>): void {
  const word = TEXT.classes[id] ?? String(id);
  const cells = scene?.counts[id] ?? 0;
  const hidden = view.solo === null ? view.hidden.has(id) : view.solo !== id;
  const locked = view.locked.has(id);
  row.count.textContent = id ? cells.toLocaleString("en") : "";
  row.name.setAttribute("aria-pressed", String(options.classId === id));
  row.name.title = TEXT.legend.choose(word, keyOf(id));
  row.node.classList.toggle("is-hidden", hidden && id > 0);
  row.node.classList.toggle("is-none", cells === 0 && id > 0);
  row.node.classList.toggle("is-locked", locked);
  fill(row.eye, icon(hidden ? "eyeOff" : "eye"));
  fill(row.lock, icon(locked ? "lock" : "unlock"));
  press(row.eye, !hidden, TEXT.legend.seen(word, !hidden, view.solo === id));
  press(row.lock, locked, TEXT.legend.locked(word, locked));
}

function press(node: HTMLElement, pressed: boolean, title: string): void {
  node.setAttribute("aria-pressed", String(pressed));
  node.setAttribute("aria-label", title);
  node.title = title;
}

function keyOf(id: number): string {
  return id === 0 ? "=" : id === 10 ? "0" : id === 11 ? "-" : String(id);
}

export function toggleSeen({ store }: App, id: number, alone: boolean): void {
  const { view } = store.get();
  if (alone) store.setView({ solo: view.solo === id ? null : id });
  else if (view.solo !== null) store.setView({ solo: view.solo === id ? null : id });
  else store.setView({ hidden: toggled(view.hidden, id) });
}

function toggleLock({ store }: App, id: number): void {
  store.setView({ locked: toggled(store.get().view.locked, id) });
}

export function toggled(set: ReadonlySet<number>, id: number): Set<number> {
  const now = new Set(set);
  if (!now.delete(id)) now.add(id);
  return now;
}
