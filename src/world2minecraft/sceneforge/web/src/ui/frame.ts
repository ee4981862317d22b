// The frame of the window: bars, side panels, the stage with the canvas, the drawer.

import { TEXT } from "../text";
import { h } from "./dom";

export interface Frame {
  root: HTMLElement;
  top: HTMLElement;
  left: HTMLElement;
  right: HTMLElement;
  stage: HTMLElement;
  canvas: HTMLCanvasElement;
  rail: HTMLElement; // tools, at the left edge of the stage
  options: HTMLElement; // of the tool, at its upper edge
  corner: HTMLElement; // ways to look, in its upper right corner
  over: HTMLElement; // parts over the scene that others hang in
  toasts: HTMLElement;
  drawer: HTMLElement;
  status: HTMLElement;
}

export function makeFrame(host: HTMLElement): Frame {
  const canvas = h("canvas", { class: "canvas", tabindex: "0", "aria-label": TEXT.stage.label });
  const rail = h("div", { class: "rail", role: "toolbar", "aria-label": TEXT.stage.tools });
  rail.setAttribute("aria-orientation", "vertical");
  const options = h("div", { class: "tool-options", role: "toolbar", "aria-label": TEXT.stage.options });
  const corner = h("div", { class: "corner", role: "toolbar", "aria-label": TEXT.stage.ways });
  const over = h("div", { class: "over" });
  const toasts = h("div", { class: "toasts", role: "log", "aria-live": "polite" });
  const stage = h("main", { class: "stage" }, canvas, over, rail, options, corner, toasts);
  const top = h("header", { class: "top" });
  const left = h("aside", { class: "side left", "aria-label": TEXT.panels.left });
  const right = h("aside", { class: "side right", "aria-label": TEXT.panels.right });
  const drawer = h("section", { class: "drawer", "aria-label": TEXT.panels.drawer });
  const status = h("footer", { class: "status", "aria-label": TEXT.status.label });
  const root = h("div", { class: "window" }, top, left, stage, right, drawer, status);
  host.replaceChildren(root);
  return { root, top, left, right, stage, canvas, rail, options, corner, over, toasts, drawer, status };
}
