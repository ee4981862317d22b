// Build: the scene as blocks of the game. A click tells what a block is and selects its object.

import { nameOf } from "../names";
import { TEXT } from "../text";
import { fill, h } from "../ui/dom";
import { check, segment } from "../ui/fields";
import { registerMode, registerPanel, registerStagePart, type App } from "../ui/slots";
import { Builder } from "./builder";
import { LIGHTS, type Light } from "./material";
import { describe } from "./words";

const STYLES = ["blocks", "display", "voxels"] as const;
const CLICK_PX = 4;
const builders = new WeakMap<App, Builder>();

/** The one builder of a page, which Walk shares. */
export function builderOf(app: App): Builder {
  const old = builders.get(app);
  if (old) return old;
  const made = new Builder(app);
  builders.set(app, made);
  listenForClicks(app, made);
  return made;
}

export function registerBuild(): void {
  registerMode("build", {
    enter: (app) => builderOf(app).show(true),
    leave: (app) => builderOf(app).show(false),
  });
  const modes = ["build"] as const;
  registerPanel({ id: "build", title: TEXT.build.title, place: "right", modes: ["build", "walk"], order: 10, mount: mountWishes });
  registerPanel({ id: "block", title: TEXT.build.block, place: "right", modes, order: 20, mount: mountBlock });
  registerStagePart({ id: "building", mount: mountBusy });
}

function mountWishes(host: HTMLElement, app: App): void {
  const builder = builderOf(app);
  const { loader, blocks } = builder;
  const words = TEXT.build;
  const voxel = (): number => 1 / (app.store.get().scene?.voxel_m ?? 0.08);
  const sizes = (): number[] => [1, 2, 4, voxel()];
  const size = segment<string>(
    words.size,
    () => sizes().map((value) => ({ value: String(value), label: words.sizes(value, value === voxel()) })),
    (value) => builder.wish({ size: Number(value) }),
  );
  const style = segment<string>(
    words.style,
    () => STYLES.map((value) => ({ value, label: words.styles[value] })),
    (value) => builder.wish({ style: value }),
  );
  const lamp = segment<Light>(
    words.light,
    () => LIGHTS.map((value) => ({ value, label: words.lights[value] })),
    (value) => {
      blocks.material.setLight(value);
      builder.view.invalidate();
      show();
    },
  );
  const open = check(words.cutOpen, "cut-open", (on) => builder.setCutOpen(on));
  const facts = h("p", { class: "note", data: { build: "facts" } });
  const group = (title: string, node: HTMLElement): HTMLElement[] => [h("h3", { class: "sub" }, title), node];
  const rows = [group(words.size, size.node), group(words.style, style.node), group(words.light, lamp.node)].flat();
  host.append(h("div", { class: "wishes" }, ...rows, open.node, facts));
  const show = (): void => {
    size.set(String(loader.wish.size));
    style.set(loader.wish.style as (typeof STYLES)[number]);
    lamp.set(blocks.material.light);
    open.set(builder.cutOpen);
    const { mesh } = loader;
    facts.textContent = mesh ? words.facts(mesh.facts.blocks, mesh.facts.palette.length - 1) : "";
  };
  builder.watch(show);
  app.store.watch(["scene"], show);
}

function mountBlock(host: HTMLElement, app: App): void {
  const builder = builderOf(app);
  const { actions } = app;
  const body = h("div", { class: "stack", data: { build: "block" } });
  host.append(body);
  const show = (): void => {
    const { clicked } = builder;
    if (!clicked) {
      fill(body, h("p", { class: "note" }, TEXT.build.click));
      return;
    }
    const { name, id, facts } = describe(clicked.state);
    const one = app.store.get().objects.get(clicked.object);
    const rows = facts.map(([key, value]) => h("div", { class: "block-fact" }, h("dt", {}, key), h("dd", {}, value)));
    fill(
      body,
      h("strong", { data: { build: "name" } }, name),
      h("code", { class: "block-id" }, id),
      rows.length > 0 && h("dl", { class: "block-facts" }, ...rows),
      h("p", { data: { build: "object" } }, TEXT.build.partOf(one && nameOf(one))),
      one?.placements[0] && h("p", { class: "note" }, TEXT.templateName(one.placements[0].template)),
      one && h("div", { class: "row is-even" }, actions.button("object.turnBack", { icon: "turnBack" }), actions.button("object.turn", { icon: "turn" })),
      one && h("div", { class: "row is-even" }, actions.button("object.templateBack", { label: TEXT.inspector.previous }), actions.button("object.template", { label: TEXT.inspector.next })),
    );
  };
  builder.watch(show);
  app.store.watch(["objects"], show);
}

/** A word over the scene while blocks are made. */
function mountBusy(host: HTMLElement, app: App): void {
  const builder = builderOf(app);
  const chip = h("div", { class: "building", role: "status", hidden: true }, TEXT.build.busy);
  host.append(chip);
  const show = (): void => {
    const { mode } = app.store.get();
    chip.hidden = !(builder.loader.busy && (mode === "build" || mode === "walk"));
  };
  builder.watch(show);
  app.store.watch(["mode"], show);
}

/** The view turns by the same button: only a press that stays in place is a click. */
function listenForClicks(app: App, builder: Builder): void {
  let down: [number, number] | null = null;
  const ours = (event: PointerEvent): boolean => {
    const { mode, tool } = app.store.get();
    return mode === "build" && tool === "navigate" && event.button === 0;
  };
  app.canvas.addEventListener("pointerdown", (event) => {
    down = ours(event) ? [event.offsetX, event.offsetY] : null;
  });
  app.canvas.addEventListener("pointerup", (event) => {
    if (!down || !ours(event)) return;
    const moved = Math.hypot(event.offsetX - down[0], event.offsetY - down[1]);
    if (moved < CLICK_PX) builder.clickAt(event.offsetX, event.offsetY);
    down = null;
  });
}
