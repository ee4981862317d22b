// Holes of floor, walls and ceiling: listed by plane with what they miss, filled by one press each.

import type { Run } from "../wire";
import { TEXT } from "../text";
import { cannotEdit } from "./blocked";
import { fill, h, setWhy } from "./dom";
import { plainButton } from "./fields";
import { unfold } from "./panels";
import { rove } from "./rove";
import type { App } from "./slots";

interface Hole {
  plane: string;
  share: number;
  cells: number;
  runs: Run[];
}

const FILLED = "#7fd6a4";

export function mountHoles(host: HTMLElement, app: App): void {
  let holes: Hole[] = [];
  let looked = false;
  const note = h("p", { class: "note", "aria-live": "polite" }, TEXT.holes.note);
  const list = h("div", { class: "found-list", role: "group", "aria-label": TEXT.holes.title });
  const show = (some: readonly Hole[]): void =>
    app.view.setOverlay("holes", some.length ? some.flatMap((one) => one.runs) : null, FILLED);
  const draw = (): void => {
    const open = holes.filter((one) => one.cells > 0);
    show(open);
    note.textContent = looked ? TEXT.holes.found(open.length) : TEXT.holes.note;
    fill(list, ...open.map((one) => row(app, one, () => show([one]), () => show(open))));
  };
  const look = async (): Promise<void> => {
    looked = true;
    holes = (await app.ask<Hole[]>("holes")) ?? [];
    draw();
  };
  const find = plainButton(TEXT.holes.find, () => void look(), "button is-wide");
  find.dataset.do = "find-holes";
  host.append(h("div", { class: "stack" }, find, note, list));
  rove(list);
  app.actions.on("holes.fill", {
    run: () => {
      unfold("holes");
      void look();
    },
    why: () => (app.store.get().scene ? "" : TEXT.why.noScene),
  });
  app.connection.onChange(() => looked && void look());
  app.store.watch(["mode"], ({ mode }) => {
    if (mode === "voxels" || !looked) return;
    looked = false;
    holes = [];
    draw();
  });
}

function row(app: App, hole: Hole, over: () => void, out: () => void): HTMLElement {
  const node = h(
    "button",
    { type: "button", class: "found", data: { plane: hole.plane } },
    h("span", { class: "tree-word" }, TEXT.holes.plane(hole.plane)),
    h("span", { class: "muted" }, TEXT.holes.share(hole.share)),
    h("span", { class: "legend-count" }, TEXT.holes.fill(hole.cells)),
  );
  setWhy(node, cannotEdit(app.store), TEXT.holes.fillOne(hole.plane));
  for (const kind of ["pointerenter", "focus"]) node.addEventListener(kind, over);
  for (const kind of ["pointerleave", "blur"]) node.addEventListener(kind, out);
  node.addEventListener("click", () => {
    if (!cannotEdit(app.store)) void app.do({ op: "fill_holes", plane: hole.plane });
  });
  return node;
}
