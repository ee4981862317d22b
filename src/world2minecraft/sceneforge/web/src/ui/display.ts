// How the scene is drawn: sizes, opacity, edges, by what cells are coloured.

import type { ColourBy } from "../store";
import { TEXT } from "../text";
import { fill, h } from "./dom";
import { check, segment, slider } from "./fields";
import type { App } from "./slots";

const COLOURS: ColourBy[] = ["class", "confidence", "colour", "difference"];

export function mountDisplay(host: HTMLElement, { store }: App): void {
  const words = TEXT.display;
  const size = slider({
    label: words.voxelSize,
    id: "voxel-size",
    min: 0.3,
    max: 1,
    step: 0.05,
    show: TEXT.percent,
    change: (voxelSize) => store.setView({ voxelSize }),
  });
  const opacity = slider({
    label: words.opacity,
    id: "opacity",
    min: 0.05,
    max: 1,
    step: 0.05,
    show: TEXT.percent,
    change: (value) => store.setView({ opacity: value }),
  });
  const centre = slider({
    label: words.centerSize,
    id: "center-size",
    min: 0,
    max: 0.4,
    step: 0.02,
    show: TEXT.centimetres,
    change: (centerSize) => store.setView({ centerSize }),
  });
  const edges = check(words.edges, "edges", (on) => store.setView({ edges: on }));
  const colour = segment<ColourBy>(
    words.colourBy,
    () => COLOURS.map((value) => ({ value, label: words.colours[value], why: whyNot(value, store.get().scene?.has.truth) })),
    (colourBy) => store.setView({ colourBy }),
  );
  const legend = h("p", { class: "note colour-legend" });
  host.append(
    h("div", { class: "stack" }, size.node, opacity.node, centre.node, edges.node),
    h("h3", { class: "sub" }, words.colourBy),
    colour.node,
    legend,
  );
  store.watch(["view", "scene"], ({ view }) => {
    size.set(view.voxelSize);
    opacity.set(view.opacity);
    centre.set(view.centerSize);
    edges.set(view.edges);
    colour.set(view.colourBy);
    const ramp = view.colourBy === "confidence" && h("span", { class: "ramp" });
    fill(legend, ramp && words.doubtful, ramp, words.legends[view.colourBy]);
  });
}

function whyNot(value: ColourBy, truth: boolean | undefined): string {
  return value === "difference" && !truth ? TEXT.why.nothingToCompare : "";
}
