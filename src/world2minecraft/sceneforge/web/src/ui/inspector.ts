// The selected object: class, furniture among the best five, turn, size, place, what can be done.

import { OWN_CELLS, type Alternative, type SceneObject } from "../wire";
import { nameOf, offeredNames } from "../names";
import { TEXT } from "../text";
import { cannotEdit } from "./blocked";
import { collidingWith, leavesRoom } from "./clashes";
import { fill, h, setWhy } from "./dom";
import { icon } from "./icons";
import { rove } from "./rove";
import type { App } from "./slots";

const FIRST_OBJECT = 5;

export function mountInspector(host: HTMLElement, app: App): void {
  const { store, connection } = app;
  const body = h("div", { class: "stack" });
  host.append(body);
  let shown = "";
  let asked = 0;
  const draw = (): void => {
    const { selectedObjects, objects, online } = store.get();
    const those = [...selectedObjects].flatMap((id) => objects.get(id) ?? []);
    const [one] = those;
    const key = JSON.stringify([those, online]);
    if (key === shown) return;
    shown = key;
    asked += 1;
    if (!one) fill(body, h("p", { class: "note" }, TEXT.inspector.none));
    else if (those.length > 1) fill(body, ...severalParts(app, those));
    else {
      const list = h("div", { class: "templates", role: "group", "aria-label": TEXT.inspector.templates });
      fill(body, ...oneParts(app, one, list));
      showTemplates(app, one, list, one.placements[0]?.alternatives ?? []);
      const mine = asked;
      connection
        .ask<Alternative[]>("alternatives", { id: one.id })
        .then((best) => mine === asked && showTemplates(app, one, list, best))
        .catch(() => undefined); // Those that came with the object stay.
    }
  };
  store.watch(["objects", "selectedObjects", "online"], draw);
  store.watch(["clashes", "objects", "selectedObjects"], () => {
    const place = body.querySelector<HTMLElement>(".clashes");
    const [id] = store.get().selectedObjects;
    if (place && id !== undefined) fill(place, ...clashRows(app, id));
  });
}

function clashRows({ store, selection }: App, id: number): HTMLElement[] {
  const { clashes, objects } = store.get();
  const others = collidingWith(id, clashes).flatMap((other) => objects.get(other) ?? []);
  const links = others.map((other) =>
    h("button", { type: "button", class: "link", data: { clash: String(other.id) }, on: { click: () => selection.objects([other.id]) } }, nameOf(other)),
  );
  return [
    links.length > 0 && h("p", { class: "clash" }, icon("warn"), h("span", {}, TEXT.clashes.collides), ...links),
    leavesRoom(id, clashes) && h("p", { class: "clash" }, icon("warn"), h("span", {}, TEXT.clashes.outside)),
  ].filter((row) => row !== false);
}

function oneParts(app: App, one: SceneObject, list: HTMLElement): HTMLElement[] {
  const { actions } = app;
  const title = h(
    "div",
    { class: "object-title" },
    h("span", { class: "swatch", vars: { "--swatch": colourOf(app, one.class_id) } }),
    h("strong", {}, nameOf(one)),
    h("span", { class: "muted" }, TEXT.inspector.confidence(one.confidence)),
  );
  return [
    title,
    h("div", { class: "clashes", role: "status", "aria-label": TEXT.clashes.title }),
    nameField(app, [one]),
    classField(app, [one]),
    h("h3", { class: "sub" }, TEXT.inspector.templates),
    list,
    h("div", { class: "row is-even" }, actions.button("object.templateBack", { label: TEXT.inspector.previous }), actions.button("object.template", { label: TEXT.inspector.next })),
    turnField(app, one),
    facts(one),
    h("div", { class: "row is-even" }, actions.button("object.floor", { icon: "floor", label: TEXT.inspector.floor }), actions.button("object.wall", { icon: "wall", label: TEXT.inspector.wall })),
    h("div", { class: "row is-even" }, actions.button("object.duplicate", { icon: "duplicate", label: TEXT.inspector.duplicate }), actions.button("object.split", { icon: "split", label: TEXT.inspector.split })),
    h("div", { class: "row is-even" }, actions.button("object.rematch", { icon: "template", label: TEXT.inspector.rematch }), actions.button("delete", { icon: "trash", label: TEXT.inspector.remove, class: "button is-danger" })),
  ];
}

function severalParts(app: App, those: SceneObject[]): HTMLElement[] {
  const { actions } = app;
  return [
    h("strong", {}, TEXT.inspector.several(those.length)),
    nameField(app, those),
    classField(app, those),
    h("div", { class: "row is-even" }, actions.button("object.turn", { icon: "turn", label: TEXT.inspector.turnRight }), actions.button("object.merge", { icon: "merge", label: TEXT.inspector.merge })),
    h("div", { class: "row is-even" }, actions.button("object.rematch", { icon: "template", label: TEXT.inspector.rematch }), actions.button("delete", { icon: "trash", label: TEXT.inspector.remove, class: "button is-danger" })),
  ];
}

function nameField(app: App, those: SceneObject[]): HTMLElement {
  const [first] = those;
  const held = those.every((one) => one.title === first?.title) ? (first?.title ?? "") : "";
  const names = h("datalist", { id: "object-names" }, ...offeredNames(first?.class_id ?? 0).map((value) => h("option", { value })));
  const input = h("input", { type: "text", maxlength: 60, value: held, list: names.id, data: { field: "name" }, "aria-label": TEXT.inspector.name });
  const blocked = cannotEdit(app.store);
  setWhy(input, blocked, first ? TEXT.inspector.nameOf(first.name_confidence) : "");
  input.disabled = blocked !== "";
  input.addEventListener("change", () => {
    if (input.value.trim() === held) return;
    void app
      .do({ op: "rename_objects", ids: those.map((one) => one.id), name: input.value })
      .then((rev) => rev === null && (input.value = held));
  });
  return h("label", { class: "field is-plain" }, h("span", {}, TEXT.inspector.name), input, names);
}

function classField(app: App, those: SceneObject[]): HTMLElement {
  const classes = (app.store.get().scene?.classes ?? []).filter(({ id }) => id >= FIRST_OBJECT);
  const same = those.every((one) => one.class_id === those[0]?.class_id);
  const select = h(
    "select",
    { data: { field: "class" }, "aria-label": TEXT.inspector.class },
    !same && h("option", { value: "" }, TEXT.inspector.mixed),
    ...classes.map(({ id }) => h("option", { value: id }, TEXT.classes[id])),
  );
  select.value = same ? String(those[0]?.class_id) : "";
  setWhy(select, cannotEdit(app.store), TEXT.inspector.class);
  select.disabled = cannotEdit(app.store) !== "";
  select.addEventListener("change", () => {
    void app
      .do({ op: "relabel_objects", ids: those.map((one) => one.id), class_id: Number(select.value) })
      .then((rev) => rev === null && (select.value = String(those[0]?.class_id)));
  });
  return h("label", { class: "field is-plain" }, h("span", {}, TEXT.inspector.class), select);
}

function showTemplates(app: App, one: SceneObject, list: HTMLElement, best: readonly Alternative[]): void {
  const now = one.placements[0];
  const known: Alternative[] = now
    ? [{ template: now.template, quarter_turns: now.quarter_turns, iou: now.iou }, ...best]
    : [...best];
  const rows = known.filter(
    (a, at) => known.findIndex((b) => b.template === a.template && b.quarter_turns === a.quarter_turns) === at,
  );
  if (!rows.length) {
    fill(list, h("p", { class: "note" }, TEXT.inspector.noTemplate));
    return;
  }
  fill(list, ...rows.slice(0, 6).map((row) => templateRow(app, one, row, row === rows[0] && now !== undefined)));
  rove(list);
}

function templateRow(app: App, one: SceneObject, row: Alternative, chosen: boolean): HTMLElement {
  const own = row.template === OWN_CELLS;
  const node = h(
    "button",
    { type: "button", class: "template", data: { template: row.template }, vars: { "--share": own ? "0%" : `${row.iou * 100}%` } },
    h("span", { class: "template-name" }, TEXT.templateName(row.template)),
    h("span", { class: "template-turn" }, `${row.quarter_turns * 90}°`),
    !own && h("span", { class: "template-iou" }, TEXT.objects.fit(row.iou)),
  );
  node.setAttribute("aria-pressed", String(chosen));
  const name = TEXT.templateName(row.template);
  setWhy(node, cannotEdit(app.store), own ? name : TEXT.inspector.iouOf(name, row.iou));
  node.addEventListener("click", () => {
    if (chosen || cannotEdit(app.store)) return;
    const { template, quarter_turns } = row;
    void app.do({ op: "set_template", id: one.id, template, quarter_turns });
  });
  return node;
}

function turnField(app: App, one: SceneObject): HTMLElement {
  const now = ((Math.round(one.yaw_deg / 90) % 4) + 4) % 4;
  const buttons = [0, 1, 2, 3].map((turns) => {
    const button = h("button", { type: "button", data: { turn: String(turns) } }, `${turns * 90}°`);
    button.setAttribute("aria-pressed", String(turns === now));
    setWhy(button, cannotEdit(app.store), TEXT.inspector.turnTo(turns * 90));
    button.addEventListener("click", () => {
      const by = (turns - now + 4) % 4;
      if (by && !cannotEdit(app.store)) {
        void app.do({ op: "turn_objects", ids: [one.id], quarter_turns: by });
      }
    });
    return button;
  });
  const row = h("div", { class: "segment", role: "group", "aria-label": TEXT.inspector.turn }, ...buttons);
  rove(row);
  return h("div", { class: "field is-plain" }, h("span", {}, TEXT.inspector.turn), row);
}

function facts(one: SceneObject): HTMLElement {
  const rows: [string, string][] = [
    [TEXT.inspector.size, TEXT.metres(one.size_m)],
    [TEXT.inspector.place, TEXT.position(one.center_m)],
    [TEXT.inspector.cells, one.cells.toLocaleString("en")],
  ];
  return h("dl", { class: "facts" }, ...rows.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]));
}

function colourOf({ store }: App, id: number): string {
  return `rgb(${(store.get().scene?.classes[id]?.colour ?? [128, 128, 128]).join(" ")})`;
}
