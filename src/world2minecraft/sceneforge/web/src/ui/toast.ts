// One line over the scene that goes by itself: what was refused, what was done.

import { h } from "./dom";

const STAYS_MS = { info: 3500, error: 7000 };
const MOST = 3;

export function makeToast(host: HTMLElement): (text: string, kind?: "info" | "error") => void {
  return (text, kind = "info") => {
    const node = h("div", { class: `toast is-${kind}` }, text);
    for (const old of host.children) if (old.textContent === text) old.remove();
    host.append(node);
    while (host.children.length > MOST) host.firstElementChild?.remove();
    setTimeout(() => node.remove(), STAYS_MS[kind]);
  };
}
