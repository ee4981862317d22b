// The page's table of contents: what hangs itself in, then the start.

import "./style.css";
import "./style_controls.css";
import "./style_stage.css";
import { Store } from "./store";
import { startApp } from "./ui/app";
import { noView } from "./ui/no_view";
import { h } from "./ui/dom";

const store = new Store();
const host = document.querySelector<HTMLElement>("#app") ?? document.body.appendChild(h("div"));

void startApp(host, store, () => noView()).then((app) => {
  const { view, connection } = app;
  Object.assign(window, { __forge: { store, view, connection, app, idle: () => view.idle() } });
});
