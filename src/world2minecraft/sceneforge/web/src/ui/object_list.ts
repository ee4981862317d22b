// All objects as a tree by class. Choosing one selects it and looks at it.

import type { State } from "../store";
import { OWN_CELLS, type SceneObject } from "../wire";
import { combineOf } from "../tools/selection";
import { boxOf } from "../tools/objects_at";
import { isFound, nameOf } from "../names";
import { TEXT } from "../text";
import { clashWords } from "./clashes";
import { fill, h } from "./dom";
import { icon } from "./icons";
import type { App } from "./slots";

export function mountObjectList(host: HTMLElement, app: App): void {
  const { store } = app;
  const tree = h("ul", { class: "tree", role: "tree", "aria-label": TEXT.objects.title });
  tree.setAttribute("aria-multiselectable", "true");
  const folded = new Set<number>();
  const search = h("input", {
    type: "search",
    class: "tree-search",
    placeholder: TEXT.objects.find,
    title: TEXT.objects.search,
    "aria-label": TEXT.objects.search,
    autocomplete: "off",
    spellcheck: "false",
  });
  host.append(search, tree);
  const draw = (): void => {
    const held = tree.contains(document.activeElement)
      ? (document.activeElement as HTMLElement).dataset.key
      : undefined;
    const typed = search.value.trim();
    fill(tree, ...branches(app, typed ? new Set() : folded, typed));
    const none = store.get().objects.size ? TEXT.objects.notFound : TEXT.objects.none;
    if (!tree.children.length) tree.append(h("li", { class: "note" }, none));
    setStop(tree, held);
  };
  store.watch(["objects", "selectedObjects", "clashes"], draw);
  search.addEventListener("input", draw);
  tree.addEventListener("click", (event) => {
    const item = (event.target as HTMLElement).closest<HTMLElement>("[role=treeitem]");
    if (!item) return;
    item.focus();
    if (item.dataset.object) choose(app, Number(item.dataset.object), event);
    else if (item.dataset.branch) {
      fold(folded, Number(item.dataset.branch));
      draw();
    }
  });
  tree.addEventListener("keydown", (event) => walk(event, tree));
  tree.addEventListener("focusin", (event) => setStop(tree, (event.target as HTMLElement).dataset.key));
}

function branches({ store }: App, folded: ReadonlySet<number>, typed: string): HTMLElement[] {
  const { objects, scene } = store.get();
  const byClass = new Map<number, SceneObject[]>();
  for (const one of objects.values()) {
    if (typed && !isFound(one, typed)) continue;
    byClass.set(one.class_id, [...(byClass.get(one.class_id) ?? []), one]);
  }
  return (scene?.classes ?? [])
    .filter(({ id }) => byClass.has(id))
    .flatMap(({ id, colour }) => {
      const those = byClass.get(id) ?? [];
      const head = h(
        "li",
        {
          role: "treeitem",
          class: "tree-branch",
          tabindex: "-1",
          "aria-level": "1",
          "aria-expanded": String(!folded.has(id)),
          data: { branch: String(id), key: `b${id}` },
        },
        icon("down"),
        h("span", { class: "swatch", vars: { "--swatch": `rgb(${colour.join(" ")})` } }),
        h("span", { class: "tree-word" }, TEXT.classes[id]),
        h("span", { class: "legend-count" }, TEXT.objects.count(those.length)),
      );
      const leaves = folded.has(id) ? [] : those.sort((a, b) => a.id - b.id);
      return [head, ...leaves.map((one) => leaf(one, store.get()))];
    });
}

function leaf(one: SceneObject, state: Readonly<State>): HTMLElement {
  const best = one.placements[0];
  const clash = clashWords(one.id, state);
  const fit = best?.template === OWN_CELLS ? TEXT.objects.ownCells : best && TEXT.objects.fit(best.iou);
  return h(
    "li",
    {
      role: "treeitem",
      class: "tree-leaf",
      tabindex: "-1",
      "aria-level": "2",
      "aria-selected": String(state.selectedObjects.has(one.id)),
      data: { object: String(one.id), key: `o${one.id}` },
    },
    h("span", { class: "tree-word" }, nameOf(one)),
    clash && h("span", { class: "tree-clash", role: "img", "aria-label": clash, title: clash }, icon("warn")),
    h("span", { class: "legend-count", title: TEXT.objects.iou }, fit || "–"),
  );
}

function choose(app: App, id: number, event: MouseEvent): void {
  app.selection.objects([id], combineOf(event));
  const one = app.store.get().objects.get(id);
  if (one && event.detail === 2) app.view.focus(boxOf(one));
}

function fold(folded: Set<number>, id: number): void {
  if (!folded.delete(id)) folded.add(id);
}

/** One stop of the Tab key: the item that had it, the selected one, or the first. */
function setStop(tree: HTMLElement, key: string | undefined): void {
  const items = itemsOf(tree);
  const stop =
    items.find((one) => one.dataset.key === key) ??
    items.find((one) => one.getAttribute("aria-selected") === "true") ??
    items[0];
  for (const one of items) one.tabIndex = one === stop ? 0 : -1;
  if (key && stop !== document.activeElement && stop?.dataset.key === key) stop.focus();
}

function walk(event: KeyboardEvent, tree: HTMLElement): void {
  const items = itemsOf(tree);
  const at = items.indexOf(document.activeElement as HTMLElement);
  const item = items[at];
  const { key } = event;
  if (!item) return;
  const steps: Record<string, number> = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: items.length - 1 };
  const open = item.getAttribute("aria-expanded");
  if (key in steps) items[steps[key] ?? 0]?.focus();
  else if (key === "Enter" || key === " ") item.click();
  else if ((key === "ArrowLeft" && open === "true") || (key === "ArrowRight" && open === "false")) item.click();
  else return;
  event.preventDefault();
  event.stopPropagation();
}

function itemsOf(tree: HTMLElement): HTMLElement[] {
  return [...tree.querySelectorAll<HTMLElement>("[role=treeitem]")];
}
