// The page is made with these few functions: no framework.

export type Child = Node | string | number | null | undefined | false;
type Handler = (event: never) => void;

export interface Props {
  class?: string;
  on?: Record<string, Handler>;
  data?: Record<string, string>;
  vars?: Record<string, string>; // CSS custom properties
  [name: string]: unknown;
}

const AS_PROPERTY = new Set(["value", "checked", "indeterminate", "textContent", "htmlFor"]);

/** Make an element: attributes by name, handlers under `on`, children after. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  props: Props = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(props)) {
    if (value === undefined || value === null || value === false) continue;
    if (name === "class") node.className = value as string;
    else if (name === "on") listen(node, value as Record<string, Handler>);
    else if (name === "data") Object.assign(node.dataset, value);
    else if (name === "vars") setVars(node, value as Record<string, string>);
    else if (AS_PROPERTY.has(name)) Object.assign(node, { [name]: value });
    else node.setAttribute(name, value === true ? "" : String(value));
  }
  append(node, children);
  return node;
}

export function append(node: Element, children: readonly Child[]): void {
  for (const child of children) {
    if (child === null || child === undefined || child === false) continue;
    node.append(child instanceof Node ? child : String(child));
  }
}

/** Put other children into an element. */
export function fill(node: Element, ...children: Child[]): void {
  node.replaceChildren();
  append(node, children);
}

export function setVars(node: HTMLElement, vars: Record<string, string>): void {
  for (const [name, value] of Object.entries(vars)) node.style.setProperty(name, value);
}

function listen(node: Element, handlers: Record<string, Handler>): void {
  for (const [name, call] of Object.entries(handlers)) {
    node.addEventListener(name, call as unknown as EventListener);
  }
}

/** Say why a control cannot be used; an empty reason enables it. It keeps its place in the tab order. */
export function setWhy(node: HTMLElement, why: string, title: string): void {
  if (why) {
    node.setAttribute("aria-disabled", "true");
    node.setAttribute("aria-description", why);
    node.title = `${title} · ${why}`;
  } else {
    node.removeAttribute("aria-disabled");
    node.removeAttribute("aria-description");
    node.title = title;
  }
}

/** Whether typing goes into this element, so that single keys are no commands. */
export function takesText(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target instanceof HTMLInputElement) {
    return !["range", "checkbox", "radio", "button"].includes(target.type);
  }
  return target instanceof HTMLTextAreaElement || target.isContentEditable;
}
