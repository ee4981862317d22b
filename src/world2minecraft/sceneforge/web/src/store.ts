// What one tab knows. Parts of the page subscribe to the keys that they show.

import type { Clash, HeldRun, Scene, SceneObject } from "./wire";

export type Mode = "inspect" | "voxels" | "objects" | "build" | "walk";
export type ColourBy = "class" | "confidence" | "colour" | "difference";

export interface View {
  hidden: ReadonlySet<number>; // class ids that are not drawn
  solo: number | null;
  locked: ReadonlySet<number>; // class ids that no tool changes
  voxelSize: number; // 0.3 .. 1, share of a cell
  opacity: number; // 0.05 .. 1
  centerSize: number; // metres
  edges: boolean;
  colourBy: ColourBy;
  slice: { axis: 0 | 1 | 2; low: number; high: number } | null; // cells, inclusive
  section: { low: [number, number, number]; high: [number, number, number] } | null; // cells
}

/** What the last change of the document did to the arrays, which are changed in place. */
export interface Touched {
  rev: number;
  runs: readonly HeldRun[] | null; // null: everything may have changed
}

/** What tools do next; each tab has its own. */
export interface ToolOptions {
  classId: number; // that is painted or added
  shape: "sphere" | "cube" | "single";
  size: number; // diameter of the brush in cells
  depth: number; // how many cells behind what is seen a box or lasso selects; 0: all the way
  fills: "empty" | "occupied" | "all"; // which cells the brush changes
  surfaceOnly: boolean; // only what is seen, not what lies behind it
  snap: boolean; // objects that are moved come to rest on what is below
}

export interface State {
  scene: Scene | null;
  labels: Uint8Array; // [X, Y, Z] C order
  instance: Uint16Array;
  confidence: Uint8Array; // 0..255
  touched: Touched;
  objects: ReadonlyMap<number, SceneObject>;
  clashes: ReadonlyMap<number, readonly Clash[]>; // by the id of each object that takes part
  mode: Mode;
  tool: string; // "navigate", "brush", "box", "lasso", "flood", "measure", ...
  options: ToolOptions;
  view: View;
  selectedObjects: ReadonlySet<number>;
  selectedCells: ReadonlySet<number>; // flat cell numbers
  theme: "dark" | "light";
  status: string;
  online: boolean;
}

export type Key = keyof State;
type Listener = (state: State, changed: ReadonlySet<Key>) => void;

const START: State = {
  scene: null,
  labels: new Uint8Array(0),
  instance: new Uint16Array(0),
  confidence: new Uint8Array(0),
  touched: { rev: 0, runs: null },
  objects: new Map(),
  clashes: new Map(),
  mode: "inspect",
  tool: "navigate",
  options: { classId: 10, shape: "sphere", size: 3, depth: 0, fills: "empty", surfaceOnly: true, snap: false },
  view: {
    hidden: new Set([1]), // The ceiling: the whole room is in view.
    solo: null,
    locked: new Set(),
    voxelSize: 1,
    opacity: 1,
    centerSize: 0.12,
    edges: true,
    colourBy: "class",
    slice: null,
    section: null,
  },
  selectedObjects: new Set(),
  selectedCells: new Set(),
  theme: "dark",
  status: "",
  online: false,
};

export class Store {
  private state: State = START;
  private listeners: { keys: readonly Key[]; call: Listener }[] = [];

  get(): Readonly<State> {
    return this.state;
  }

  set(change: Partial<State>): void {
    this.state = { ...this.state, ...change };
    const changed = new Set(Object.keys(change) as Key[]);
    for (const { keys, call } of this.listeners) {
      if (keys.some((key) => changed.has(key))) call(this.state, changed);
    }
  }

  setView(change: Partial<View>): void {
    this.set({ view: { ...this.state.view, ...change } });
  }

  setOptions(change: Partial<ToolOptions>): void {
    this.set({ options: { ...this.state.options, ...change } });
  }

  /** Call back now and whenever one of the keys changes; returns what ends it. */
  watch(keys: readonly Key[], call: Listener): () => void {
    const entry = { keys, call };
    this.listeners.push(entry);
    call(this.state, new Set(keys));
    return () => {
      this.listeners = this.listeners.filter((one) => one !== entry);
    };
  }
}
