// How a room shall be built: its scale, its furniture, and a length that the person knows.

import { TEXT } from "../text";
import { fill, h } from "../ui/dom";
import { segment } from "../ui/fields";
import type { Choice, StartTold, Survey } from "./told";

export interface Choices {
  node: HTMLElement;
  choice(): Choice;
  why(): string; // why it cannot be started so; empty where it can
}

export function makeChoices(told: StartTold, survey: Survey, changed: () => void): Choices {
  const words = TEXT.start;
  let scale = told.scale;
  let style = told.styles[0] ?? "blocks";
  const scaleHint = h("p", { class: "note" });
  const styleHint = h("p", { class: "note" });
  const scales = segment(
    words.size,
    () => told.scales.map((one) => ({ value: String(one), label: words.sizeNames[String(one)] ?? String(one) })),
    (value) => {
      scale = Number(value);
      show();
    },
  );
  const styles = segment(
    words.style,
    () => told.styles.map((one) => ({ value: one, label: words.styles[one] ?? one })),
    (value) => {
      style = value;
      show();
    },
  );
  const known = knownLength(told, changed);
  const show = (): void => {
    scales.set(String(scale));
    styles.set(style);
    fill(scaleHint, words.sizes[String(scale)]);
    fill(styleHint, words.styleHints[style]);
    changed();
  };
  const node = h(
    "section",
    { class: "choices", "aria-label": words.choices },
    h("h3", {}, words.choices),
    h("div", { class: "choice" }, h("span", { class: "choice-name" }, words.size), scales.node, scaleHint),
    h("div", { class: "choice" }, h("span", { class: "choice-name" }, words.style), styles.node, styleHint),
    !survey.has_scale && known.node,
  );
  queueMicrotask(show);
  return {
    node,
    choice: () => ({ blocks_per_metre: scale, style, known: survey.has_scale ? null : known.value() }),
    why: () => (survey.has_scale ? "" : known.why()),
  };
}

function knownLength(told: StartTold, changed: () => void): { node: HTMLElement; value(): [string, number] | null; why(): string } {
  const words = TEXT.start;
  const names = Object.keys(told.known);
  const options = names.map((name) => h("option", { value: name }, name));
  const select = h("select", { "aria-label": words.known, data: { field: "known" } }, h("option", { value: "" }, words.knownNone), ...options);
  const metres = h("input", { type: "number", step: 0.01, min: 0.02, max: 40, "aria-label": words.knownMetres, data: { field: "metres" } });
  metres.hidden = true;
  select.addEventListener("change", () => {
    const limits = told.known[select.value];
    metres.hidden = !limits;
    if (limits) [metres.min, metres.max] = [String(limits[0]), String(limits[1])];
    if (limits) metres.focus();
    changed();
  });
  metres.addEventListener("input", changed);
  const value = (): [string, number] | null =>
    select.value && metres.valueAsNumber > 0 ? [select.value, metres.valueAsNumber] : null;
  const node = h(
    "div",
    { class: "choice" },
    h("span", { class: "choice-name" }, words.known),
    h("div", { class: "row" }, select, metres),
    h("p", { class: "note" }, words.knownHint),
  );
  return { node, value, why: () => (select.value && !value() ? words.why.known : "") };
}
