// Fields that panels share: a slider with its value, a choice among few, a box to tick.

import { fill, h, setWhy } from "./dom";

export interface Slider {
  node: HTMLElement;
  input: HTMLInputElement;
  set(value: number): void;
}

export function slider(look: {
  label: string;
  min: number;
  max: number;
  step: number;
  show: (value: number) => string;
  change: (value: number) => void;
  id: string;
}): Slider {
  const output = h("output", {});
  const input = h("input", {
    type: "range",
    min: look.min,
    max: look.max,
    step: look.step,
    "aria-label": look.label,
    data: { field: look.id },
  });
  const set = (value: number): void => {
    input.value = String(value);
    output.textContent = look.show(value);
    input.setAttribute("aria-valuetext", look.show(value));
  };
  input.addEventListener("input", () => {
    const value = Number(input.value);
    set(value);
    look.change(value);
  });
  const node = h("label", { class: "field" }, h("span", {}, look.label), input, output);
  return { node, input, set };
}

export interface Choice<T extends string> {
  value: T;
  label: string;
  why?: string; // why it cannot be chosen
}

export function segment<T extends string>(
  label: string,
  choices: () => readonly Choice<T>[],
  change: (value: T) => void,
): { node: HTMLElement; set(value: T): void } {
  const node = h("div", { class: "segment", role: "group", "aria-label": label });
  const set = (value: T): void => {
    const held = node.contains(document.activeElement);
    const buttons = choices().map((choice) => {
      const button = h("button", { type: "button", data: { value: choice.value } }, choice.label);
      button.setAttribute("aria-pressed", String(choice.value === value));
      setWhy(button, choice.why ?? "", choice.label);
      button.addEventListener("click", () => {
        if (!choice.why) change(choice.value);
      });
      return button;
    });
    fill(node, ...buttons);
    if (held) buttons.find((one) => one.getAttribute("aria-pressed") === "true")?.focus();
  };
  return { node, set };
}

export function check(
  label: string,
  id: string,
  change: (on: boolean) => void,
): { node: HTMLElement; set(on: boolean): void } {
  const input = h("input", { type: "checkbox", data: { field: id } });
  input.addEventListener("change", () => change(input.checked));
  const node = h("label", { class: "check" }, input, label);
  return { node, set: (on) => (input.checked = on) };
}

/** A plain button that is not in the key table. */
export function plainButton(
  label: string,
  run: () => void,
  look = "button",
): HTMLButtonElement & { why?: string } {
  const node: HTMLButtonElement & { why?: string } = h("button", { type: "button", class: look }, label);
  node.addEventListener("click", () => {
    if (node.getAttribute("aria-disabled") !== "true") run();
  });
  return node;
}
