// The tools of the mode, at the left edge of the scene, and ways to look in its lower corner.

import type { Mode } from "../store";
import { h } from "./dom";
import type { IconName } from "./icons";
import { rove } from "./rove";
import type { App } from "./slots";

type Entry = [action: string, icon: IconName] | null; // null: a line between

const ALWAYS: Entry[] = [["tool.navigate", "navigate"]];
const MEASURE: Entry = ["tool.measure", "measure"];

const RAILS: Record<Mode, Entry[]> = {
  inspect: [...ALWAYS, MEASURE],
  voxels: [
    ...ALWAYS,
    ["tool.brush", "brush"],
    ["tool.erase", "erase"],
    ["tool.box", "box"],
    ["tool.lasso", "lasso"],
    ["tool.flood", "flood"],
    ["tool.eyedropper", "eyedropper"],
    MEASURE,
  ],
  objects: [
    ...ALWAYS,
    ["tool.move", "move"],
    ["tool.add", "add"],
    MEASURE,
    null,
    ["object.turnBack", "turnBack"],
    ["object.turn", "turn"],
    ["object.split", "split"],
    ["object.merge", "merge"],
    ["object.duplicate", "duplicate"],
    ["object.floor", "floor"],
    ["object.wall", "wall"],
    ["delete", "trash"],
  ],
  build: [...ALWAYS, MEASURE],
  walk: [],
};

export function mountRail(host: HTMLElement, { actions, store }: App): void {
  let shown: Mode | null = null;
  store.watch(["mode"], ({ mode }) => {
    if (mode === shown) return;
    shown = mode;
    host.replaceChildren(
      ...RAILS[mode].map((entry) =>
        entry
          ? actions.button(entry[0], { icon: entry[1], class: "button icon-only tool" })
          : h("hr", { class: "rail-line" }),
      ),
    );
  });
  rove(host);
}

export function mountCorner(host: HTMLElement, { actions }: App): void {
  host.append(
    actions.button("view.reset", { icon: "home" }),
    actions.button("view.focus", { icon: "focus" }),
    actions.button("view.top", { icon: "viewTop" }),
    actions.button("view.front", { icon: "viewFront" }),
    actions.button("view.side", { icon: "viewSide" }),
    actions.button("view.ortho", { icon: "ortho" }),
  );
  rove(host);
}
