// What can be done with selected objects, by keys, buttons and the palette alike.

import { boxOf } from "../tools/objects_at";
import { TEXT } from "../text";
import type { Alternative, SceneObject } from "../wire";
import { cannotEdit } from "./blocked";
import type { App } from "./slots";

const FIRST_OBJECT = 5;

export function selectedOf({ store }: App): SceneObject[] {
  const { selectedObjects, objects } = store.get();
  return [...selectedObjects].flatMap((id) => objects.get(id) ?? []);
}

export function objectActions(app: App): void {
  const { actions, store } = app;
  const some = (): string => cannotEdit(store) || (selectedOf(app).length ? "" : TEXT.why.noObject);
  const one = (): string => some() || (selectedOf(app).length === 1 ? "" : TEXT.why.oneObject);
  const two = (): string => some() || (selectedOf(app).length > 1 ? "" : TEXT.why.twoObjects);
  const ids = (): number[] => selectedOf(app).map(({ id }) => id);
  const on = (id: string, why: () => string, command: () => Record<string, unknown>): void =>
    actions.on(id, { why, run: () => void app.do({ op: "", ...command() }) });

  on("object.turn", some, () => ({ op: "turn_objects", ids: ids(), quarter_turns: 1 }));
  on("object.turnBack", some, () => ({ op: "turn_objects", ids: ids(), quarter_turns: 3 }));
  on("object.split", one, () => ({ op: "split_object", id: ids()[0], parts: 2 }));
  on("object.merge", two, () => ({ op: "merge_objects", ids: ids() }));
  on("object.duplicate", one, () => ({ op: "duplicate_object", id: ids()[0] }));
  on("object.floor", one, () => ({ op: "snap_object", id: ids()[0], to: "floor" }));
  on("object.wall", one, () => ({ op: "snap_object", id: ids()[0], to: "wall" }));
  on("object.rematch", some, () => ({ op: "rematch", ids: ids() }));
  const structure = (): string => (store.get().options.classId < FIRST_OBJECT ? TEXT.why.notAnObject : "");
  on("object.relabel", () => some() || structure(), () => ({
    op: "relabel_objects",
    ids: ids(),
    class_id: store.get().options.classId,
  }));
  actions.on("object.template", { why: one, run: () => void nextTemplate(app, 1) });
  actions.on("object.templateBack", { why: one, run: () => void nextTemplate(app, -1) });
  actions.on("object.next", { why: () => none(app), run: () => stepObject(app, 1) });
  actions.on("object.previous", { why: () => none(app), run: () => stepObject(app, -1) });
}

function none({ store }: App): string {
  return store.get().objects.size ? "" : TEXT.why.noObjects("");
}

/** Go along the best five; the list is asked anew for each object, so that it is of its cells now. */
const lists = new Map<number, Alternative[]>();

async function nextTemplate(app: App, by: number): Promise<void> {
  const [one] = selectedOf(app);
  if (!one) return;
  let list = lists.get(one.id) ?? [];
  const at = list.findIndex((row) => isNow(one, row));
  if (at < 0) {
    list = [...((await app.ask<Alternative[]>("alternatives", { id: one.id })) ?? [])];
    if (!list.length) return;
    const now = one.placements[0];
    if (now && !list.some((row) => isNow(one, row))) list.unshift({ ...now });
    lists.set(one.id, list);
  }
  const from = list.findIndex((row) => isNow(one, row));
  const next = list[(Math.max(from, 0) + by + list.length) % list.length];
  if (!next || list.length < 2) return app.toast(TEXT.why.noOtherTemplate);
  const { template, quarter_turns } = next;
  await app.do({ op: "set_template", id: one.id, template, quarter_turns });
}

function isNow(one: SceneObject, row: Alternative): boolean {
  const now = one.placements[0];
  return now?.template === row.template && now.quarter_turns === row.quarter_turns;
}

function stepObject(app: App, by: number): void {
  const all = [...app.store.get().objects.values()].sort((a, b) => a.class_id - b.class_id || a.id - b.id);
  const at = all.findIndex(({ id }) => app.store.get().selectedObjects.has(id));
  const next = all[(at + (at < 0 && by < 0 ? 0 : by) + all.length) % all.length];
  if (!next) return;
  app.selection.objects([next.id]);
  app.view.focus(boxOf(next));
}
