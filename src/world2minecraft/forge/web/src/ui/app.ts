// Puts the page together: frame, panels, keys; then opens the document or shows the start page.

import { Connection, NoDocument, type AnyCommand } from "../connection";
import type { Mode, Store } from "../store";
import { TEXT } from "../text";
import { Actions } from "./actions";
import { cannotEdit } from "./blocked";
import { h } from "./dom";
import { makeFrame } from "./frame";
import { listenToKeys } from "./keyboard";
import { closeMenu } from "./menu";
import { mountDrawer, mountSide } from "./panels";
import { slots, type App } from "./slots";
import { mountStatusLine } from "./status_line";
import { applyTheme, switchTheme } from "./theme";
import { makeToast } from "./toast";
import { MODES, mountTopBar } from "./top_bar";
import type { ViewLike } from "./view_like";

type MakeView = (canvas: HTMLCanvasElement, store: Store) => ViewLike;

export async function startApp(host: HTMLElement, store: Store, makeView: MakeView): Promise<App> {
  applyTheme(store);
  const frame = makeFrame(host);
  const toast = makeToast(frame.toasts);
  const connection = new Connection(store);
  const actions = new Actions(store, (why) => toast(why, "error"));
  const view = makeView(frame.canvas, store);
  const tell = (error: unknown): null => {
    const text = error instanceof Error ? error.message : String(error);
    store.set({ status: text });
    toast(text, "error");
    return null;
  };
  const app: App = {
    store,
    view,
    connection,
    actions,
    stage: frame.stage,
    canvas: frame.canvas,
    toast,
    do: (command: AnyCommand) => connection.do(command).catch(tell),
    ask: <T>(name: string, fields = {}) => connection.ask<T>(name, fields).catch(tell),
  };
  pageActions(app, tell);
  mountTopBar(frame.top, app);
  mountSide(frame.left, "left", app);
  mountSide(frame.right, "right", app);
  mountStatusLine(frame.status, app);
  for (const part of slots.stageParts()) {
    const place = h("div", { class: "over-part", data: { part: part.id } });
    frame.over.append(place);
    part.mount(place, app);
  }
  mountDrawer(frame.drawer, app);
  listenToKeys(store, actions);
  for (const kind of ["pointerdown", "keydown", "wheel"]) {
    addEventListener(kind, () => connection.active(), { passive: true });
  }
  changeModes(app);
  await open(app, frame.root);
  return app;
}

async function open(app: App, root: HTMLElement): Promise<void> {
  try {
    await app.connection.open();
    app.view.frame();
  } catch (error) {
    const start = slots.startPage();
    if (error instanceof NoDocument && start) {
      root.classList.add("is-start");
      const page = h("div", { class: "start-page" });
      root.append(page);
      start(page, app);
    } else app.toast(error instanceof Error ? error.message : TEXT.error.load, "error");
  }
}

function pageActions({ actions, store, connection, toast }: App, tell: (error: unknown) => null): void {
  const blocked = (): string => cannotEdit(store);
  actions.on("undo", {
    run: () => void connection.undo().catch(tell),
    why: () => blocked() || (store.get().scene?.undo ? "" : TEXT.why.nothingToUndo),
  });
  actions.on("redo", {
    run: () => void connection.redo().catch(tell),
    why: () => blocked() || (store.get().scene?.redo ? "" : TEXT.why.nothingToRedo),
  });
  actions.on("save", {
    run: () => void connection.save().then(() => toast(TEXT.top.saved), tell),
    why: blocked,
  });
  actions.on("theme", () => switchTheme(store));
  actions.on("cancel", () => void closeMenu());
  for (const mode of MODES) {
    actions.on(`mode.${mode}`, {
      run: () => store.set({ mode }),
      why: () => (store.get().scene ? "" : TEXT.why.noScene),
    });
  }
}

function changeModes(app: App): void {
  let last: Mode | null = null;
  app.store.watch(["mode"], ({ mode }) => {
    if (mode === last) return;
    if (last) for (const hooks of slots.hooks(last)) hooks.leave?.(app);
    last = mode;
    document.body.dataset.mode = mode;
    for (const hooks of slots.hooks(mode)) hooks.enter?.(app);
  });
}
