// What can be done to a whole class at once.

import type { SceneObject } from "../wire";
import { TEXT } from "../text";
import { openMenu, type MenuItem } from "./menu";
import type { App } from "./slots";
import { cannotEdit } from "./blocked";
import { recluster } from "./recluster";

const FIRST_OBJECT = 5;

export function classMenu(app: App, id: number, owner: HTMLElement): void {
  const box = owner.getBoundingClientRect();
  openMenu(items(app, id, owner), box.left, box.bottom + 4, owner, box.right);
}

function items(app: App, id: number, owner: HTMLElement): MenuItem[] {
  const { store } = app;
  const { scene, view } = store.get();
  const word = TEXT.classes[id] ?? "";
  const none = scene?.counts[id] ? "" : TEXT.why.noneOfClass(word);
  const locked = view.locked.has(id) ? TEXT.why.locked(word) : "";
  const why = cannotEdit(store) || none || locked;
  const bulk: MenuItem[] = [
    { label: TEXT.legend.relabel, why, run: () => chooseClass(app, id, owner) },
    {
      label: TEXT.legend.deleteAll(word),
      why,
      danger: true,
      run: () => void app.do({ op: "delete_class", class_id: id }),
    },
  ];
  return [
    { label: TEXT.legend.solo(word), hint: "Alt+click", run: () => store.setView({ solo: view.solo === id ? null : id }) },
    { label: TEXT.legend.selectCells(word), why: none, run: () => selectCells(app, id) },
    ...(id >= FIRST_OBJECT ? objectItems(app, id, why) : []),
    ...bulk,
  ];
}

function objectItems(app: App, id: number, why: string): MenuItem[] {
  const word = TEXT.classes[id] ?? "";
  const ids = [...app.store.get().objects.values()]
    .filter((one: SceneObject) => one.class_id === id)
    .map((one) => one.id);
  const few = why || (ids.length < 2 ? TEXT.why.tooFew(word) : "");
  const missing = why || (ids.length ? "" : TEXT.why.noObjects(word));
  return [
    {
      label: TEXT.legend.selectObjects(word),
      why: ids.length ? "" : TEXT.why.noObjects(word),
      run: () => app.store.set({ mode: "objects", selectedObjects: new Set(ids) }),
    },
    { label: TEXT.legend.mergeAll, why: few, run: () => void app.do({ op: "merge_objects", ids }) },
    {
      label: TEXT.legend.splitEach,
      why: missing,
      run: () => void app.do({ op: "split_objects", ids, parts: 2 }),
    },
    { label: TEXT.legend.rematch, why: missing, run: () => void app.do({ op: "rematch", ids }) },
    {
      label: TEXT.legend.recluster,
      hint: TEXT.legend.splits,
      why,
      run: () => recluster(app, id),
    },
  ];
}

function chooseClass(app: App, from: number, owner: HTMLElement): void {
  const box = owner.getBoundingClientRect();
  const classes = app.store.get().scene?.classes ?? [];
  const choices = classes
    .filter(({ id }) => id && id !== from)
    .map(({ id, colour }) => ({
      label: TEXT.classes[id] ?? String(id),
      swatch: `rgb(${colour.join(" ")})`,
      run: () => void app.do({ op: "relabel_class", from_id: from, to_id: id }),
    }));
  openMenu(choices, box.left, box.bottom + 4, owner, box.right);
}

function selectCells({ store }: App, id: number): void {
  const { labels } = store.get();
  const found = new Set<number>();
  labels.forEach((label, flat) => label === id && found.add(flat));
  store.set({ mode: "voxels", selectedCells: found });
}
