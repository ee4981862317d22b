// What the chosen tool can be told: shape, size, depth; always in view, never a hidden mode.

import type { State, ToolOptions } from "../store";
import { TEXT } from "../text";
import { fill, h } from "./dom";
import { check, segment, slider } from "./fields";
import { icon } from "./icons";
import { openMenu } from "./menu";
import type { App } from "./slots";

type Make = (app: App) => { nodes: HTMLElement[]; show(state: Readonly<State>): void };

const MAKERS: Record<string, Make> = {
  brush: (app) => joined(classPicker(app), brushShape(app), fills(app)),
  erase: (app) => joined(brushShape(app)),
  box: (app) => joined(depth(app), words(TEXT.tools.combine)),
  lasso: (app) => joined(depth(app), words(TEXT.tools.combine)),
  flood: () => joined(words(TEXT.tools.flood), words(TEXT.tools.combine)),
  eyedropper: () => joined(words(TEXT.tools.eyedropper)),
  measure: () => joined(words(TEXT.tools.measure)),
  add: (app) => joined(classPicker(app), words(TEXT.tools.add)),
  move: () => joined(words(TEXT.tools.move)),
};

export function mountToolOptions(host: HTMLElement, app: App): void {
  let shown = "";
  let part: ReturnType<Make> | null = null;
  app.store.watch(["tool", "options", "mode", "scene"], (state) => {
    if (state.tool !== shown) {
      shown = state.tool;
      part = MAKERS[state.tool]?.(app) ?? null;
      fill(host, ...(part?.nodes ?? []));
    }
    host.hidden = !part || state.mode === "walk";
    part?.show(state);
  });
}

function joined(...parts: ReturnType<Make>[]): ReturnType<Make> {
  return { nodes: parts.flatMap((one) => one.nodes), show: (state) => parts.forEach((one) => one.show(state)) };
}

function words(text: string): ReturnType<Make> {
  return { nodes: [h("span", { class: "note" }, text)], show: () => undefined };
}

/** The class that is painted or added; a press opens the list of all. */
function classPicker(app: App): ReturnType<Make> {
  const swatch = h("span", { class: "swatch" });
  const word = h("span", {});
  const node = h(
    "button",
    { type: "button", class: "button", "aria-haspopup": "menu", data: { picker: "class" } },
    swatch,
    word,
    icon("down"),
  );
  node.addEventListener("click", () => {
    const box = node.getBoundingClientRect();
    const items = (app.store.get().scene?.classes ?? [])
      .filter(({ id }) => id > 0)
      .map(({ id, colour }) => ({
        label: TEXT.classes[id] ?? "",
        swatch: `rgb(${colour.join(" ")})`,
        run: () => app.store.setOptions({ classId: id }),
      }));
    openMenu(items, box.left, box.bottom + 4, node);
  });
  return {
    nodes: [node],
    show: ({ scene, options }) => {
      const colour = scene?.classes[options.classId]?.colour ?? [128, 128, 128];
      swatch.style.setProperty("--swatch", `rgb(${colour.join(" ")})`);
      word.textContent = TEXT.classes[options.classId] ?? "";
      node.title = TEXT.tools.paints(TEXT.classes[options.classId] ?? "");
    },
  };
}

function brushShape({ store }: App): ReturnType<Make> {
  const shapes: ToolOptions["shape"][] = ["sphere", "cube", "single"];
  const shape = segment<ToolOptions["shape"]>(
    TEXT.tools.shape,
    () => shapes.map((value) => ({ value, label: TEXT.tools.shapes[value] })),
    (value) => store.setOptions({ shape: value }),
  );
  const size = slider({
    label: TEXT.tools.size,
    id: "brush-size",
    min: 1,
    max: 15,
    step: 1,
    show: String,
    change: (value) => store.setOptions({ size: value }),
  });
  size.node.classList.add("is-compact");
  return {
    nodes: [shape.node, size.node],
    show: ({ options }) => {
      shape.set(options.shape);
      size.set(options.size);
      size.node.hidden = options.shape === "single";
    },
  };
}

function fills({ store }: App): ReturnType<Make> {
  const kinds: ToolOptions["fills"][] = ["empty", "occupied", "all"];
  const kind = segment<ToolOptions["fills"]>(
    TEXT.tools.fills,
    () => kinds.map((value) => ({ value, label: TEXT.tools.fillsWords[value] })),
    (value) => store.setOptions({ fills: value }),
  );
  return { nodes: [kind.node], show: ({ options }) => kind.set(options.fills) };
}

function depth({ store }: App): ReturnType<Make> {
  const surface = check(TEXT.tools.surface, "surface", (on) => store.setOptions({ surfaceOnly: on }));
  const limit = slider({
    label: TEXT.tools.depth,
    id: "depth",
    min: 0,
    max: 40,
    step: 1,
    show: (value) => (value ? TEXT.cells(value) : TEXT.tools.through),
    change: (value) => store.setOptions({ depth: value }),
  });
  limit.node.classList.add("is-compact");
  return {
    nodes: [surface.node, limit.node],
    show: ({ options }) => {
      surface.set(options.surfaceOnly);
      limit.set(options.depth);
      limit.node.hidden = options.surfaceOnly;
    },
  };
}
