// The page's table of contents: what hangs itself in, then the start.

import "./style.css";
import "./style_controls.css";
import "./style_stage.css";
import "./style_panels.css";
import { Store } from "./store";
import { startApp } from "./ui/app";
import { h } from "./ui/dom";
import { registerEditing } from "./ui/editing";
import { registerHints } from "./ui/hints";
import { SceneView } from "./view/view";

const store = new Store();
const host = document.querySelector<HTMLElement>("#app") ?? document.body.appendChild(h("div"));

registerEditing();
registerHints();

void startApp(host, store, (canvas) => new SceneView(canvas, store)).then((app) => {
  const { view, connection } = app;
  Object.assign(window, { __forge: { store, view, connection, app, idle: () => view.idle() } });
});
