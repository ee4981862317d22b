// The box that takes "go to the lamp", and what is answered under it.

import { fill, h, type Child } from "../ui/dom";
import { icon } from "../ui/icons";
import "./go_box.css";

export interface GoWords {
  label: string;
  go: string;
  who?: string;
  planner?: string;
  agentHint?(name: string): string;
  hint(name: string): string;
}

const EXAMPLES = ["lamp", "sofa", "bed", "desk", "oven", "table"]; // short, and most rooms have one

export class GoBox {
  readonly node: HTMLElement;
  private readonly input: HTMLInputElement;
  private readonly names = h("datalist", { id: "go-names" });
  private readonly said = h("div", { class: "go-said", role: "status" });
  private readonly who: HTMLSelectElement;
  private example = "";

  constructor(
    private readonly words: GoWords,
    asked: (text: string) => void,
  ) {
    this.input = h("input", {
      class: "go-input",
      type: "text",
      name: "goal",
      autocomplete: "off",
      enterkeyhint: "go",
      maxlength: 120,
      list: this.names.id,
      placeholder: words.label,
      "aria-label": words.label,
    });
    const send = h("button", { class: "button is-main go-send", type: "submit" }, words.go);
    this.who = h("select", { class: "go-who", name: "who", hidden: true, "aria-label": words.who ?? "" });
    const form = h("form", { class: "go-form" }, icon("search"), this.input, this.who, send, this.names);
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      asked(this.input.value.trim() || this.example);
      this.input.blur(); // Keys are for walking again, and a phone puts its keyboard away.
    });
    this.node = h("div", { class: "go" }, form, this.said);
  }

  /** The names that are offered while one types; one of them is the example. */
  offer(names: readonly string[]): void {
    const example = EXAMPLES.find((word) => names.includes(word)) ?? names[0];
    this.example = example ? this.words.hint(example) : "";
    this.input.placeholder = this.example || this.words.label;
    fill(this.names, ...[...new Set(names)].map((value) => h("option", { value })));
  }

  /** The models that may walk in place of the planner. */
  offerAgents(names: readonly string[], title: (name: string) => string): void {
    const { words } = this;
    const options = names.map((name) => h("option", { value: name, title: words.agentHint?.(title(name)) ?? "" }, title(name)));
    fill(this.who, h("option", { value: "" }, words.planner ?? ""), ...options);
    this.who.hidden = !names.length;
  }

  /** The model that is chosen; "" is the planner. */
  get agent(): string {
    return this.who.value;
  }

  focus(): void {
    this.input.focus();
    this.input.select();
  }

  say(text: string, ...more: Child[]): void {
    fill(this.said, text, ...more);
  }
}

/** Buttons of the names that may have been meant. */
export function nearNames(names: readonly string[], ask: (name: string) => void): HTMLElement {
  const buttons = names.map((name) => h("button", { class: "button go-near", type: "button", on: { click: () => ask(name) } }, name));
  return h("span", { class: "go-nears" }, ...buttons);
}
