// A change of the document that the server sent, put into what this tab knows.

import type { Store } from "./store";
import type { Change, HeldRun } from "./wire";

export function applyChange(store: Store, change: Change): void {
  const { scene, labels, instance, confidence, objects, selectedObjects } = store.get();
  if (!scene) return;
  const runs = change.cells ?? [];
  writeRuns(runs, labels, instance, confidence);
  const now = new Map(objects);
  for (const id of change.gone) now.delete(id);
  for (const one of change.objects) now.set(one.id, one);
  const { rev, counts, undo, redo, saved } = change;
  store.set({
    scene: { ...scene, rev, counts, undo, redo, saved, objects: [...now.values()] },
    labels,
    instance,
    confidence,
    touched: { rev, runs },
    objects: now,
    selectedObjects: new Set([...selectedObjects].filter((id) => now.has(id))),
  });
}

export function writeRuns(
  runs: readonly HeldRun[],
  labels: Uint8Array,
  instance: Uint16Array,
  confidence: Uint8Array,
): void {
  for (const [first, length, label, owner, sure] of runs) {
    labels.fill(label, first, first + length);
    instance.fill(owner, first, first + length);
    confidence.fill(sure, first, first + length);
  }
}
