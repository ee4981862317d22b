// Where other parts of the page hang themselves in: modes, panels, the start page, exports.
// Register before `startApp` runs: import the part in main.ts and call its register function there.

import type { Connection } from "../connection";
import type { Mode, Store } from "../store";
import type { Actions } from "./actions";
import type { Selection } from "../tools/selection";
import type { ViewLike } from "./view_like";

/** What each part of the page is given. */
export interface App {
  store: Store;
  view: ViewLike;
  connection: Connection;
  actions: Actions; // app.actions.on("id of keys.ts", { run, why })
  selection: Selection; // of this tab, with an undo of its own
  pointer: { at: { x: number; y: number } | null }; // over the canvas, in its CSS pixels
  stage: HTMLElement; // holds the canvas; overlays go here
  canvas: HTMLCanvasElement;
  /** One line over the scene that goes by itself. */
  toast(text: string, kind?: "info" | "error"): void;
  /** Do a command; a refusal is told to the person and gives null. */
  do(command: { op: string } & Record<string, unknown>): Promise<number | null>;
  /** Ask the server; a refusal is told to the person and gives null. */
  ask<T>(name: string, fields?: Record<string, unknown>): Promise<T | null>;
}

export interface ModeHooks {
  enter?(app: App): void;
  leave?(app: App): void;
}

export interface Panel {
  id: string;
  title: string; // from text.ts
  place: "left" | "right" | "drawer"; // drawer: below the scene, over its whole width
  modes: readonly Mode[] | "all";
  order: number; // from top to bottom, or tabs of the drawer from left to right
  closed?: boolean; // at first
  mount(host: HTMLElement, app: App): void; // once, when the page is made
}

/** Something that lies over the scene: a hint, a scale, a heads-up line. */
export interface StagePart {
  id: string;
  mount(host: HTMLElement, app: App): void;
}

export interface ExportItem {
  id: string;
  label: string; // from text.ts
  hint?: string;
  why?(app: App): string; // why it cannot be done now, empty where it can
  run(app: App): void;
}

type Mount = (host: HTMLElement, app: App) => void;

const modes = new Map<Mode, ModeHooks[]>();
const panels: Panel[] = [];
const stageParts: StagePart[] = [];
const exports: ExportItem[] = [];
let startPage: Mount | null = null;

export function registerMode(mode: Mode, hooks: ModeHooks): void {
  modes.set(mode, [...(modes.get(mode) ?? []), hooks]);
}

export function registerPanel(panel: Panel): void {
  panels.push(panel);
}

export function registerStagePart(part: StagePart): void {
  stageParts.push(part);
}

export function registerExport(item: ExportItem): void {
  exports.push(item);
}

/** The page for a server without a document (GET /api/scene answers 404). */
export function registerStartPage(mount: Mount): void {
  startPage = mount;
}

export const slots = {
  hooks: (mode: Mode): readonly ModeHooks[] => modes.get(mode) ?? [],
  panels: (place: Panel["place"]): readonly Panel[] =>
    panels.filter((one) => one.place === place).sort((a, b) => a.order - b.order),
  stageParts: (): readonly StagePart[] => stageParts,
  exports: (): readonly ExportItem[] => exports,
  startPage: (): Mount | null => startPage,
};
