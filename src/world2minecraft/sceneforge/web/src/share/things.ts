// The list of things, and the label of what is chosen.

import { fill, h } from "../ui/dom";
import { icon } from "../ui/icons";
import type { Vec3 } from "../wire";
import type { Thing } from "./data";
import { capital, TEXT } from "./text";

export function thingList(things: readonly Thing[], colours: ReadonlyMap<number, Vec3>, choose: (thing: Thing) => void): { node: HTMLElement; mark(thing: Thing | null): void } {
  const buttons = new Map<number, HTMLElement>();
  const rows = things.map((thing) => {
    const dot = h("span", { class: "thing-dot", "aria-hidden": "true" });
    dot.style.setProperty("background", `rgb(${(colours.get(thing.id) ?? [128, 128, 128]).join()})`);
    const words = h("span", { class: "thing-words" }, h("span", { class: "thing-name" }, capital(thing.name)), h("span", { class: "thing-size" }, TEXT.size(thing.size_m)));
    const button = h("button", { class: "thing", type: "button", data: { thing: String(thing.id) }, on: { click: () => choose(thing) } }, dot, words);
    buttons.set(thing.id, button);
    return h("li", {}, button);
  });
  const mark = (thing: Thing | null): void => {
    for (const [id, button] of buttons) {
      if (id === thing?.id) button.setAttribute("aria-current", "true");
      else button.removeAttribute("aria-current");
    }
    if (thing) buttons.get(thing.id)?.scrollIntoView({ block: "nearest" });
  };
  return { node: h("ul", { class: "things" }, ...rows), mark };
}

/** What floats over the thing that is chosen. */
export function thingLabel(calls: { go(thing: Thing): void; close(): void }): { node: HTMLElement; show(thing: Thing | null, canGo: boolean): void; put(at: [number, number] | null, wide: number): void } {
  const node = h("div", { class: "label glass", hidden: true, role: "group", "aria-label": TEXT.things });
  const show = (thing: Thing | null, canGo: boolean): void => {
    node.hidden = !thing;
    if (!thing) return;
    const close = h("button", { class: "button icon-only label-close", type: "button", "aria-label": TEXT.close, title: TEXT.close, on: { click: calls.close } }, icon("close"));
    fill(node,
      h("strong", { class: "label-name" }, capital(thing.name)),
      close,
      h("span", { class: "label-size" }, TEXT.size(thing.size_m)),
      canGo && h("button", { class: "button label-go", type: "button", on: { click: () => calls.go(thing) } }, TEXT.goThere),
    ); // prettier-ignore
  };
  const put = (at: [number, number] | null, wide: number): void => {
    node.style.setProperty("visibility", at ? "visible" : "hidden");
    if (!at) return;
    const half = node.offsetWidth / 2 + 8;
    const left = Math.min(Math.max(at[0], half), Math.max(wide - half, half));
    const top = Math.max(at[1], node.offsetHeight + 16);
    node.style.setProperty("transform", `translate(${Math.round(left)}px, ${Math.round(top)}px) translate(-50%, -100%)`);
  };
  return { node, show, put };
}
