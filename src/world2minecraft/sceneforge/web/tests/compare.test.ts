// Figures of comparing are those of metrics/occupancy.py: both sides are held to the same vectors.

import { describe, expect, it } from "vitest";

import { compare } from "../src/compare/count";

interface Vector {
  now: number[];
  other: number[];
  added: number;
  removed: number;
  changed: number;
  iou: number;
  miou: number;
}

const files = import.meta.glob<{ default: { cases: Vector[] } }>("../../../../../tests/sceneforge/vectors/compare.json", {
  eager: true,
});
const VECTORS = Object.values(files)[0]!.default.cases;

describe("compare", () => {
  it.each(VECTORS.map((vector, at) => [at, vector] as const))("vector %i", (_, vector) => {
    const now = Uint8Array.from(vector.now);
    const found = compare(now, Uint8Array.from(vector.other));
    expect(found.cells).toEqual({ added: vector.added, removed: vector.removed, changed: vector.changed });
    expect(found.iou).toBeCloseTo(vector.iou, 12);
    expect(found.miou).toBeCloseTo(vector.miou, 12);
  });

  it("counts what lies outside the scene as missed", () => {
    const now = Uint8Array.from([2, 0]);
    const found = compare(now, now, [5, 0, 1]);
    expect([found.iou, found.miou]).toEqual([0.5, 0.5]);
  });

  it("gives runs that name each differing cell once, in order", () => {
    const now = Uint8Array.from([0, 3, 3, 3, 0, 0, 5, 6]);
    const other = Uint8Array.from([0, 0, 0, 3, 4, 4, 6, 255]);
    const { added, removed, changed } = compare(now, other);
    expect([added, removed, changed]).toEqual([[[1, 2]], [[4, 2]], [[6, 1]]]);
  });
});
