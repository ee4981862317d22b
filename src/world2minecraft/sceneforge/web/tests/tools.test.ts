import { expect, test } from "vitest";

import { stepsSeen } from "../src/tools/cursor";
import { boundsOf, cellOf, cellsOfRuns, component, flatOf, line, runsOf, stamp } from "../src/tools/cells";
import { combined, combineOf, Selection } from "../src/tools/selection";
import { shifted } from "../src/tools/objects_at";
import { Store } from "../src/store";
import type { Vec3 } from "../src/wire";

const SHAPE: Vec3 = [5, 4, 3];
const ALL = Array.from({ length: 60 }, (_, flat) => flat);

test("a cell and its number are one thing", () => {
  for (const flat of ALL) expect(flatOf(cellOf(flat, SHAPE), SHAPE)).toBe(flat);
});

test("runs name each cell once, sorted and apart", () => {
  const cells = [7, 3, 4, 5, 3, 20, 21, 59];
  expect(runsOf(cells)).toEqual([[3, 3], [7, 1], [20, 2], [59, 1]]);
  expect(cellsOfRuns(runsOf(cells))).toEqual([3, 4, 5, 7, 20, 21, 59]);
  expect(runsOf([])).toEqual([]);
});

test("a brush is as wide as it says, round where it is a ball, and cut at the grid", () => {
  const wide: Vec3 = [20, 20, 20];
  expect(stamp([10, 10, 10], wide, "cube", 4)).toHaveLength(64);
  expect(stamp([10, 10, 10], wide, "single", 9)).toHaveLength(1);
  for (let size = 1; size <= 9; size++) {
    const ball = stamp([10, 10, 10], wide, "sphere", size);
    const box = boundsOf(ball, wide);
    expect((box?.high[0] ?? 0) - (box?.low[0] ?? 0) + 1).toBe(size);
    expect(ball.length).toBeLessThanOrEqual(size ** 3);
  }
  expect(stamp([0, 0, 0], wide, "cube", 3)).toHaveLength(8);
});

test("a line of cells leaves no gap", () => {
  const cells = line([0, 0, 0], [7, 3, -2]);
  expect(cells[0]).toEqual([0, 0, 0]);
  expect(cells.at(-1)).toEqual([7, 3, -2]);
  for (let at = 1; at < cells.length; at++) {
    const far = cells[at]?.map((value, axis) => Math.abs(value - (cells[at - 1]?.[axis] ?? 0))) ?? [];
    expect(Math.max(...far)).toBe(1);
  }
});

test("a component is what holds together by faces, not by corners or other classes", () => {
  const labels = new Uint8Array(60);
  const paint = (cell: Vec3, label: number): void => void (labels[flatOf(cell, SHAPE)] = label);
  for (const cell of [[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1]] as Vec3[]) paint(cell, 7);
  paint([2, 2, 2], 7); // only by a corner
  paint([1, 1, 0], 8);
  const found = component(0, labels, SHAPE);
  expect(found.sort((a, b) => a - b)).toEqual([0, 1, flatOf([1, 0, 1], SHAPE), flatOf([1, 1, 1], SHAPE)]);
  expect(component(flatOf([4, 3, 2], SHAPE), labels, SHAPE)).toHaveLength(60 - 6);
});

test("cells that are moved out of the grid are left out", () => {
  expect(shifted([0, 59], [1, 0, 0], SHAPE)).toEqual([flatOf([1, 0, 0], SHAPE)]);
  expect(shifted(ALL, [0, 0, 0], SHAPE)).toEqual(ALL);
});

test("modifiers combine selections", () => {
  const old = new Set([1, 2, 3]);
  const held = (shiftKey: boolean, ctrlKey: boolean) => combineOf({ shiftKey, ctrlKey, metaKey: false });
  expect([...combined(old, [3, 4], held(false, false))]).toEqual([3, 4]);
  expect([...combined(old, [3, 4], held(true, false))]).toEqual([1, 2, 3, 4]);
  expect([...combined(old, [3, 4], held(false, true))]).toEqual([1, 2]);
  expect([...combined(old, [3, 4], held(true, true))]).toEqual([3]);
});

test("undo of the selection goes back and forth, and forgets what a new one replaces", () => {
  const store = new Store();
  const selection = new Selection(store);
  const now = (): number[] => [...store.get().selectedCells];
  selection.cells([1]);
  selection.cells([2], "add");
  selection.cells([2], "add"); // changes nothing: no step
  selection.undo();
  expect(now()).toEqual([1]);
  selection.redo();
  expect(now()).toEqual([1, 2]);
  selection.undo();
  selection.undo();
  expect(now()).toEqual([]);
  expect(selection.canUndo).toBe(false);
  selection.cells([5]);
  expect(selection.canRedo).toBe(false);
});

test("the cell cursor goes to the right and away as one sees the room", () => {
  for (const [azimuth, right, away] of [
    [0, [0, 1, 0], [-1, 0, 0]],
    [Math.PI / 2, [-1, 0, 0], [0, -1, 0]],
    [Math.PI, [0, -1, 0], [1, 0, 0]],
    [-Math.PI / 2, [1, 0, 0], [0, 1, 0]],
  ] as const) {
    expect(stepsSeen(azimuth)).toEqual({ right, away });
  }
});
