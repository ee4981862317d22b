// Puts the page together: frame, panels, keys; then opens the document or shows the start page.

import { Connection, NoDocument, type AnyCommand } from "../connection";
import { sendJson } from "../start/api";
import type { Mode, Store } from "../store";
import { TEXT } from "../text";
import { Actions } from "./actions";
import { cannotEdit } from "./blocked";
import { h } from "./dom";
import { Selection } from "../tools/selection";
import { startEditing } from "./editing";
import { makeFrame } from "./frame";
import { mountHelp } from "./help";
import { listenToKeys } from "./keyboard";
import { closeMenu } from "./menu";
import { mountDrawer, mountSide } from "./panels";
import { mountPalette } from "./palette";
import { slots, type App } from "./slots";
import { mountStatusLine } from "./status_line";
import { applyTheme, switchTheme } from "./theme";
import { mountToolOptions } from "./tool_options";
import { mountCorner, mountRail } from "./tool_rail";
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
    selection: new Selection(store),
    pointer: { at: null },
    stage: frame.stage,
    canvas: frame.canvas,
    toast,
    do: (command: AnyCommand) => connection.do(command).catch(tell),
    ask: <T>(name: string, fields = {}) => connection.ask<T>(name, fields).catch(tell),
  };
  pageActions(app, tell);
  const line = mountStatusLine(frame.status, app);
  const tools = startEditing(app, (at) => {
    const hit = at && view.pick(at.x, at.y);
    line.show({ cell: hit ? hit.cell : null, flat: hit ? hit.flat : -1 });
  });
  mountTopBar(frame.top, app);
  mountRail(frame.rail, app);
  mountCorner(frame.corner, app);
  mountToolOptions(frame.options, app);
  mountSide(frame.left, "left", app);
  mountSide(frame.right, "right", app);
  const sheets = [mountPalette(app), mountHelp(app)];
  actions.on("cancel", () => {
    const done = closeMenu() || sheets.some((sheet) => sheet.close()) || tools.cancel();
    if (done) return;
    if (store.get().tool !== "navigate") store.set({ tool: "navigate" });
    else app.selection.clear();
  });
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
  tellNotes(app);
  await open(app, frame.root);
  return app;
}

/** Open the document. Where there is none the start page is shown, until there is one. */
async function open(app: App, root: HTMLElement): Promise<void> {
  const page = h("div", { class: "start-page" });
  const start = slots.startPage();
  let ready = false;
  app.store.watch(["scene"], ({ scene }) => {
    const show = ready && !scene && start !== null;
    if (show && !page.hasChildNodes()) start?.(page, app);
    if (show) root.append(page);
    else page.remove();
    root.classList.toggle("is-start", show);
  });
  try {
    await app.connection.open();
  } catch (error) {
    if (!(error instanceof NoDocument)) app.toast(error instanceof Error ? error.message : TEXT.error.load, "error");
  }
  ready = true;
  if (!app.store.get().scene) app.store.set({ scene: null });
}

/** Say once what the server has to say of a document: what was recovered, what could not be kept. */
function tellNotes({ store, toast }: App): void {
  let told = new Set<string>();
  let document = 0;
  store.watch(["scene"], ({ scene }) => {
    if (scene && scene.document !== document) told = new Set();
    document = scene?.document ?? 0;
    for (const note of scene?.notes ?? []) if (!told.has(note)) toast(note, "error");
    for (const note of scene?.notes ?? []) told.add(note);
  });
}

function pageActions({ actions, store, connection, toast }: App, tell: (error: unknown) => null): void {
  const blocked = (): string => cannotEdit(store);
  actions.on("undo", {
    run: () => void connection.undo().catch(tell),
    why: () => blocked() || (store.get().scene?.undo ? "" : TEXT.why.nothingToUndo),
    title: () => TEXT.top.undo(store.get().scene?.undo ?? ""),
  });
  actions.on("redo", {
    run: () => void connection.redo().catch(tell),
    why: () => blocked() || (store.get().scene?.redo ? "" : TEXT.why.nothingToRedo),
    title: () => TEXT.top.redo(store.get().scene?.redo ?? ""),
  });
  actions.on("save", {
    run: () => void connection.save().then(() => toast(TEXT.top.saved), tell),
    why: blocked,
  });
  actions.on("theme", () => switchTheme(store));
  actions.on("start", {
    run: () => void sendJson("api/start/close").catch(tell),
    why: () => (store.get().scene ? "" : TEXT.why.noScene),
  });
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
    app.store.set({ status: "" });
    for (const hooks of slots.hooks(mode)) hooks.enter?.(app);
  });
}
