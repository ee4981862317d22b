// Smoothing: single cells that differ from those around them become like them.

import { TEXT } from "../text";
import { cannotEdit } from "./blocked";
import { h, setWhy } from "./dom";
import { plainButton } from "./fields";
import type { App } from "./slots";

const FIRST_OBJECT = 5;

export function mountSmoothing(host: HTMLElement, app: App): void {
  const { actions, store } = app;
  const one = plainButton("", () => void app.do({ op: "smooth", class_id: store.get().options.classId }));
  const all = actions.button("cells.smooth", { label: TEXT.smoothing.all });
  host.append(
    h("div", { class: "stack" }, h("p", { class: "note" }, TEXT.smoothing.note), h("div", { class: "row is-even" }, one, all)),
  );
  store.watch(["options", "selectedCells", "scene", "online"], ({ options, selectedCells }) => {
    const word = TEXT.classes[options.classId] ?? "";
    one.textContent = TEXT.smoothing.only(word);
    setWhy(one, cannotEdit(store) || (options.classId < FIRST_OBJECT ? TEXT.why.notAnObject : ""), TEXT.smoothing.only(word));
    const label = all.querySelector("span");
    if (label) label.textContent = selectedCells.size ? TEXT.smoothing.selection : TEXT.smoothing.all;
  });
}
