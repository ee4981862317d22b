// What is selected in this tab, cells and objects, with an undo of its own: looking for the right
// selection is no change of the document.

import type { Store } from "../store";

export type Combine = "replace" | "add" | "subtract" | "intersect";

interface Kept {
  cells: ReadonlySet<number>;
  objects: ReadonlySet<number>;
}

const MOST_KEPT = 100;

/** Shift adds, Ctrl takes away, both keep what is in both. */
export function combineOf(held: { shiftKey: boolean; ctrlKey: boolean; metaKey: boolean }): Combine {
  const ctrl = held.ctrlKey || held.metaKey;
  if (held.shiftKey) return ctrl ? "intersect" : "add";
  return ctrl ? "subtract" : "replace";
}

export function combined(
  old: ReadonlySet<number>,
  found: Iterable<number>,
  how: Combine,
): Set<number> {
  const now = new Set(found);
  if (how === "replace") return now;
  if (how === "add") return new Set([...old, ...now]);
  const keep = how === "intersect";
  return new Set([...old].filter((one) => now.has(one) === keep));
}

export class Selection {
  private past: Kept[] = [];
  private future: Kept[] = [];

  constructor(private store: Store) {}

  cells(found: Iterable<number>, how: Combine = "replace"): void {
    const { selectedCells, selectedObjects } = this.store.get();
    this.change({ cells: combined(selectedCells, found, how), objects: selectedObjects });
  }

  objects(found: Iterable<number>, how: Combine = "replace"): void {
    const { selectedCells, selectedObjects } = this.store.get();
    this.change({ cells: selectedCells, objects: combined(selectedObjects, found, how) });
  }

  clear(): void {
    this.change({ cells: new Set(), objects: new Set() });
  }

  get canUndo(): boolean {
    return this.past.length > 0;
  }
  get canRedo(): boolean {
    return this.future.length > 0;
  }

  undo(): void {
    const before = this.past.pop();
    if (!before) return;
    this.future.push(this.now());
    this.put(before);
  }

  redo(): void {
    const after = this.future.pop();
    if (!after) return;
    this.past.push(this.now());
    this.put(after);
  }

  private now(): Kept {
    const { selectedCells, selectedObjects } = this.store.get();
    return { cells: selectedCells, objects: selectedObjects };
  }

  private change(next: Kept): void {
    const now = this.now();
    if (same(now.cells, next.cells) && same(now.objects, next.objects)) return;
    this.past = [...this.past.slice(1 - MOST_KEPT), now];
    this.future = [];
    this.put(next);
  }

  private put({ cells, objects }: Kept): void {
    this.store.set({ selectedCells: cells, selectedObjects: objects });
  }
}

function same(one: ReadonlySet<number>, other: ReadonlySet<number>): boolean {
  return one.size === other.size && [...one].every((value) => other.has(value));
}
