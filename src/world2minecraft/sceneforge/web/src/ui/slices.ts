// Cuts through the scene: a slice along one axis, and a box of which only the inside is drawn.

import type { State, View } from "../store";
import { TEXT } from "../text";
import type { Vec3 } from "../wire";
import { boundsOf } from "../tools/cells";
import { fill, h } from "./dom";
import { check, plainButton, segment, slider, type Slider } from "./fields";
import type { App } from "./slots";

type AxisChoice = "off" | "x" | "y" | "z";
const AXES: AxisChoice[] = ["off", "x", "y", "z"];

export function mountSlices(host: HTMLElement, app: App): void {
  const { store } = app;
  const axis = segment<AxisChoice>(
    TEXT.slices.axis,
    () => AXES.map((value) => ({ value, label: value === "off" ? TEXT.slices.off : value.toUpperCase() })),
    (value) => store.setView({ slice: sliceOf(store.get(), value) }),
  );
  const [low, high] = [bound(app, "low"), bound(app, "high")];
  const place = h("div", { class: "stack slice-fields" }, low.node, high.node);
  const section = check(TEXT.slices.section, "section", (on) =>
    store.setView({ section: on ? wholeBox(store.get()) : null }),
  );
  const sides = h("div", { class: "stack section-fields" });
  const toSelection = plainButton(TEXT.slices.toSelection, () => cutToSelection(app), "button is-wide");
  host.append(axis.node, place, h("h3", { class: "sub" }, TEXT.slices.sectionTitle), section.node, sides, toSelection);
  let bounds: Slider[] = [];
  store.watch(["view", "scene"], (state) => {
    const { view, scene } = state;
    axis.set(view.slice ? (AXES[view.slice.axis + 1] ?? "off") : "off");
    place.hidden = !view.slice;
    section.set(view.section !== null);
    if (view.slice && scene) showSlice(view.slice, scene.shape, low, high);
    if (Boolean(view.section) !== bounds.length > 0) {
      bounds = view.section && scene ? sectionSliders(app, scene.shape) : [];
      fill(sides, ...bounds.map((one) => one.node));
    }
    bounds.forEach((one, at) => one.set(sideOf(view.section, at)));
  });
}

function bound({ store }: App, which: "low" | "high"): Slider {
  return slider({
    label: TEXT.slices[which],
    id: `slice-${which}`,
    min: 0,
    max: 1,
    step: 1,
    show: String,
    change: (value) => {
      const { slice } = store.get().view;
      if (!slice) return;
      const next = { ...slice, [which]: value };
      if (next.low > next.high) next[which === "low" ? "high" : "low"] = value;
      store.setView({ slice: next });
    },
  });
}

function showSlice(slice: NonNullable<View["slice"]>, shape: Vec3, low: Slider, high: Slider): void {
  for (const one of [low, high]) one.input.max = String((shape[slice.axis] ?? 1) - 1);
  low.set(slice.low);
  high.set(slice.high);
}

function sectionSliders({ store }: App, shape: Vec3): Slider[] {
  return [0, 1, 2, 3, 4, 5].map((at) => {
    const [axis, end] = [at >> 1, at % 2 ? "high" : "low"] as [0 | 1 | 2, "low" | "high"];
    return slider({
      label: TEXT.slices.side("xyz"[axis] ?? "", end),
      id: `section-${"xyz"[axis]}-${end}`,
      min: 0,
      max: (shape[axis] ?? 1) - 1,
      step: 1,
      show: String,
      change: (value) => {
        const { section } = store.get().view;
        if (!section) return;
        const next = { low: [...section.low] as Vec3, high: [...section.high] as Vec3 };
        next[end][axis] = value;
        if (next.low[axis] > next.high[axis]) next[end === "low" ? "high" : "low"][axis] = value;
        store.setView({ section: next });
      },
    });
  });
}

function sideOf(section: View["section"], at: number): number {
  return section?.[at % 2 ? "high" : "low"][(at >> 1) as 0] ?? 0;
}

/** A slice of one cell in the middle of an axis; of z the lower part, as a plan is drawn. */
function sliceOf({ scene }: Readonly<State>, choice: AxisChoice): View["slice"] {
  const axis = AXES.indexOf(choice) - 1;
  if (axis < 0 || !scene) return null;
  const last = (scene.shape[axis] ?? 1) - 1;
  return { axis: axis as 0 | 1 | 2, low: 0, high: Math.round(last / 2) };
}

function wholeBox({ scene }: Readonly<State>): View["section"] {
  const shape = scene?.shape ?? [1, 1, 1];
  return { low: [0, 0, 0], high: shape.map((side) => side - 1) as Vec3 };
}

function cutToSelection({ store, toast }: App): void {
  const { scene, instance, selectedCells, selectedObjects } = store.get();
  if (!scene) return;
  const flats = new Set(selectedCells);
  if (selectedObjects.size) instance.forEach((id, flat) => selectedObjects.has(id) && flats.add(flat));
  const box = boundsOf(flats, scene.shape);
  if (!box) toast(TEXT.why.nothingSelected, "error");
  else store.setView({ section: box });
}

/** Move the slice by cells, keeping its thickness; the first step makes one along z. */
export function moveSlice({ store }: App, by: number): void {
  const state = store.get();
  const slice = state.view.slice ?? sliceOf(state, "z");
  const last = (state.scene?.shape[slice?.axis ?? 2] ?? 1) - 1;
  if (!slice) return;
  const high = Math.min(last, Math.max(0, slice.high + by));
  const low = slice.low === 0 ? 0 : Math.min(last, Math.max(0, slice.low + by));
  store.setView({ slice: { ...slice, low: Math.min(low, high), high } });
}
