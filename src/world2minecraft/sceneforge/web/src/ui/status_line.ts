// The line below: the cell under the pointer, where it is, what it is, what was said, frame time.

import type { Store } from "../store";
import { TEXT } from "../text";
import { h } from "./dom";
import type { App } from "./slots";

const PAUSE_MS = 500; // figures that change faster cannot be read

export interface Under {
  cell: readonly [number, number, number] | null;
  flat: number;
}

export function mountStatusLine(host: HTMLElement, app: App): { show(under: Under): void } {
  const parts = ["cell", "metres", "class", "object"].map((id) =>
    h("span", { class: `status-${id}`, data: { status: id } }),
  );
  const said = h("span", { class: "status-said", role: "status", data: { status: "said" } });
  const speed = h("span", { class: "status-speed", data: { status: "speed" } });
  host.append(...parts, said, speed);
  app.store.watch(["status"], ({ status }) => {
    said.textContent = status;
    said.title = status;
  });
  showSpeed(speed, app);
  parts[0]!.textContent = TEXT.status.none;
  return { show: (under) => parts.forEach((node, at) => (node.textContent = words(app.store, under)[at] ?? "")) };
}

/** Frame times, while one moves: of a picture that stands still they would mean nothing. */
function showSpeed(node: HTMLElement, app: App): void {
  let shown = 0;
  let timer = 0;
  app.view.onFrame.push((milliseconds) => {
    const now = performance.now();
    const moving = app.view.controls.dragging || app.store.get().mode === "walk";
    if (!moving || now - shown < PAUSE_MS) return;
    shown = now;
    node.textContent = TEXT.status.frame(milliseconds);
    clearTimeout(timer);
    timer = window.setTimeout(() => (node.textContent = ""), 4 * PAUSE_MS);
  });
}

function words(store: Store, { cell, flat }: Under): string[] {
  const { scene, labels, instance, objects } = store.get();
  if (!cell || !scene) return [TEXT.status.none, "", "", ""];
  const metres = cell.map((at, axis) => ((scene.origin_m[axis] ?? 0) + (at + 0.5) * scene.voxel_m).toFixed(2));
  const owner = instance[flat] ?? 0;
  return [
    TEXT.status.cell(cell.join(", ")),
    TEXT.status.metres(metres.join(", ")),
    TEXT.classes[labels[flat] ?? 255] ?? TEXT.status.unseen,
    owner ? TEXT.status.object(owner, objects.get(owner)?.title) : "",
  ];
}
