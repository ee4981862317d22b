// The page's table of contents: what hangs itself in, then the start.

import "./theme.css";
import "./style.css";
import "./style_controls.css";
import "./style_stage.css";
import "./style_panels.css";
import "./style_build.css";
import { builderOf, registerBuild } from "./build/mode";
import "./style_start.css";
import "./style_parts.css";
import "./style_phone.css";
import { registerCompare } from "./compare/panel";
import { registerExports } from "./export/sheet";
import { registerSceneJobs } from "./jobs/scene_jobs";
import { registerPhotos } from "./photos/strip";
import { registerStart } from "./start/page";
import { Store } from "./store";
import { TEXT } from "./text";
import { startApp } from "./ui/app";
import { h } from "./ui/dom";
import { registerEditing } from "./ui/editing";
import { registerHints } from "./ui/hints";
import { SceneView } from "./view/view";
import { registerWalk, walkingOf } from "./walk/mode";

const store = new Store();
const host = document.querySelector<HTMLElement>("#app") ?? document.body.appendChild(h("div"));

registerEditing();
registerHints();
registerBuild();
registerWalk();
registerStart();
registerPhotos();
registerCompare();
registerExports();
registerSceneJobs();

const drawn = (canvas: HTMLCanvasElement): SceneView => {
  try {
    return new SceneView(canvas, store);
  } catch (error) {
    host.replaceChildren(h("p", { class: "no-3d", role: "alert" }, TEXT.error.noView));
    throw error;
  }
};

void startApp(host, store, drawn).then((app) => {
  const { view, connection } = app;
  const build = builderOf(app);
  const walk = walkingOf(app);
  Object.assign(window, { __forge: { build, walk, store, view, connection, app, idle: () => view.idle() } });
});
