import { expect, test } from "vitest";

import { applyChange } from "../src/changes";
import { Store } from "../src/store";
import { parseVolume } from "../src/volume";
import type { Change, Scene, SceneObject } from "../src/wire";

function object(id: number): SceneObject {
  return { id, class_id: 7, name: "", name_confidence: 0, title: "sofa", center_m: [0, 0, 0], size_m: [1, 1, 1], yaw_deg: 0, confidence: 1, cells: 1, placements: [] };
}

function change(fields: Partial<Change>): Change {
  const told = { type: "change", rev: 1, kind: "paint", counts_as: "add", actor: "", step: "do" } as const;
  return { ...told, cells: [], objects: [], gone: [], counts: [], undo: "paint", redo: "", saved: false, ...fields };
}

test("a change writes its runs, and forgets objects that are gone", () => {
  const store = new Store();
  const scene = { rev: 0, objects: [], counts: [], undo: "", redo: "" } as unknown as Scene;
  const [labels, instance, confidence] = [new Uint8Array(8), new Uint16Array(8), new Uint8Array(8)];
  const objects = new Map([[1, object(1)], [2, object(2)]]);
  store.set({ scene, labels, instance, confidence, objects, selectedObjects: new Set([1, 2]) });
  applyChange(store, change({ cells: [[2, 3, 7, 300, 255]], gone: [1], objects: [object(3)], counts: [5, 0] }));
  const now = store.get();
  expect([...now.labels]).toEqual([0, 0, 7, 7, 7, 0, 0, 0]);
  expect([...now.instance]).toEqual([0, 0, 300, 300, 300, 0, 0, 0]);
  expect([...now.confidence]).toEqual([0, 0, 255, 255, 255, 0, 0, 0]);
  expect([...now.objects.keys()]).toEqual([2, 3]);
  expect([...now.selectedObjects]).toEqual([2]);
  expect(now.scene?.rev).toBe(1);
  expect(now.scene?.undo).toBe("paint");
});

function volume(wide: boolean, cells: number[], version = 1): ArrayBuffer {
  const buffer = new ArrayBuffer(40 + cells.length * (wide ? 2 : 1));
  const view = new DataView(buffer);
  "W2MV".split("").forEach((letter, at) => view.setUint8(at, letter.charCodeAt(0)));
  view.setUint16(4, version, true);
  view.setUint8(6, wide ? 1 : 0);
  [1, 2, cells.length / 2].forEach((side, axis) => view.setUint32(8 + axis * 4, side, true));
  cells.forEach((cell, at) => (wide ? view.setUint16(40 + at * 2, cell, true) : view.setUint8(40 + at, cell)));
  return buffer;
}

test("volumes are read as they are sent, and what is none is refused", () => {
  expect([...parseVolume(volume(false, [1, 2, 3, 4])).cells]).toEqual([1, 2, 3, 4]);
  expect([...parseVolume(volume(true, [1, 2, 300, 65535])).cells]).toEqual([1, 2, 300, 65535]);
  expect(parseVolume(volume(false, [1, 2, 3, 4])).shape).toEqual([1, 2, 2]);
  expect(() => parseVolume(new ArrayBuffer(4))).toThrow("not a volume");
  expect(() => parseVolume(volume(false, [1, 2], 2))).toThrow("another version");
  expect(() => parseVolume(volume(true, [1, 2]).slice(0, 43))).toThrow("cut volume");
});
