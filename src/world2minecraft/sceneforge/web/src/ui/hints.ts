// Three hints when the page is first seen. They lie beside the scene and go for good when closed.

import { TEXT } from "../text";
import { h } from "./dom";
import { icon } from "./icons";
import { registerStagePart, type App } from "./slots";

const MEMORY = "sceneforge.hints";

export function registerHints(): void {
  registerStagePart({ id: "hints", mount });
}

function mount(host: HTMLElement, app: App): void {
  if (localStorage.getItem(MEMORY) === "seen") return;
  const close = h("button", { type: "button", class: "button icon-only", "aria-label": TEXT.hints.close });
  close.append(icon("close"));
  close.title = TEXT.hints.close;
  const items = TEXT.hints.list.map(([keys, what]) => h("li", {}, h("kbd", { class: "key" }, keys), h("span", {}, what)));
  const card = h(
    "section",
    { class: "hints", "aria-label": TEXT.hints.title },
    h("ul", {}, ...items),
    close,
  );
  close.addEventListener("click", () => {
    localStorage.setItem(MEMORY, "seen");
    card.remove();
    app.canvas.focus();
  });
  const stop = app.store.watch(["scene", "mode"], ({ scene, mode }) => {
    if (scene && !card.parentElement && mode !== "walk") {
      host.append(card);
      queueMicrotask(() => stop());
    }
  });
}
