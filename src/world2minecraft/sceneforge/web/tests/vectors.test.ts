// The same vectors as tests/sceneforge/test_edit_vectors.py: both sides must do the same.

import { describe, expect, it } from "vitest";

import { writeRuns } from "../src/changes";
import { component, runsOf as toolRuns } from "../src/tools/cells";
import { cellOf, changedCells, flatOf, runsOf } from "../src/view/volume";
import type { HeldRun, Run, Vec3 } from "../src/wire";

const files = import.meta.glob<{ default: { cases: unknown[] } }>("../../../../../tests/sceneforge/vectors/*.json", {
  eager: true,
});

function casesOf<T>(name: string): T[] {
  const [, file] = Object.entries(files).find(([path]) => path.endsWith(`/${name}.json`))!;
  return file.default.cases as T[];
}

interface Held {
  labels: number[];
  instance: number[];
  confidence: number[];
}

describe("changes", () => {
  const cases = casesOf<{ before: Held; after: Held; done: HeldRun[]; undone: HeldRun[] }>("changes");

  it.each(cases.map((one, i) => [i, one] as const))("number %i is done and undone as in Python", (_, one) => {
    const { before, after, done, undone } = one;
    const labels = Uint8Array.from(before.labels);
    const instance = Uint16Array.from(before.instance);
    const confidence = Uint8Array.from(before.confidence);
    const now = () => ({ labels: [...labels], instance: [...instance], confidence: [...confidence] });
    const seen = labels.slice();
    writeRuns(done, labels, instance, confidence);
    expect(now()).toEqual(after);
    const touched = changedCells(seen, labels);
    expect(touched).toEqual(before.labels.flatMap((label, flat) => (label === after.labels[flat] ? [] : [flat])));
    writeRuns(undone, labels, instance, confidence);
    expect(now()).toEqual(before);
  });
});

describe("runs", () => {
  it.each(casesOf<{ shape: Vec3; cells: Vec3[]; flat: number[]; runs: Run[] }>("runs"))(
    "of $cells are $runs",
    ({ shape, cells, flat, runs }) => {
      const flats = cells.map((cell) => flatOf(shape, ...cell));
      expect([...flats].sort((a, b) => a - b)).toEqual(flat);
      expect(flats.map((one) => cellOf(shape, one))).toEqual(cells);
      expect(runsOf(flats)).toEqual(runs);
      expect(toolRuns(flats)).toEqual(runs);
    },
  );
});

describe("flood", () => {
  it.each(casesOf<{ shape: Vec3; labels: number[]; seed: number; runs: Run[] }>("flood"))(
    "from $seed takes what Python takes",
    ({ shape, labels, seed, runs }) => {
      expect(toolRuns(component(seed, Uint8Array.from(labels), shape))).toEqual(runs);
    },
  );
});
