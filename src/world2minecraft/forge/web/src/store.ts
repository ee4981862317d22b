// What one tab knows. Parts of the page subscribe to the keys that they show.

import type { Scene, SceneObject } from "./wire";

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

export interface State {
  scene: Scene | null;
  labels: Uint8Array; // [X, Y, Z] C order
  instance: Uint16Array;
  confidence: Uint8Array; // 0..255
  objects: ReadonlyMap<number, SceneObject>;
  mode: Mode;
  tool: string; // "navigate", "brush", "box", "lasso", "flood", "measure", ...
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
  objects: new Map(),
  mode: "inspect",
  tool: "navigate",
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
