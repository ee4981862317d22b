import { describe, expect, it } from "vitest";

import { pickCell, walkRay, type Seen } from "../src/view/pick";
import { isOccupied, type Cell } from "../src/view/volume";
import type { Vec3 } from "../src/wire";
import { random, someScene } from "./scenes";

const SHAPE: Vec3 = [9, 7, 8];

function seen(change: Partial<Seen> = {}): Seen {
  const visible = Array.from({ length: 256 }, (_, id) => isOccupied(id));
  return { visible, low: [0, 0, 0], high: SHAPE, ...change };
}

/** Slow and readable: where a ray enters each cell's box; the nearest one. */
function bruteForce(labels: Uint8Array, { visible, low, high }: Seen, from: Vec3, direction: Vec3) {
  let best: { cell: Cell; t: number } | null = null;
  for (let x = low[0]; x < high[0]; x++)
    for (let y = low[1]; y < high[1]; y++)
      for (let z = low[2]; z < high[2]; z++) {
        const label = labels[(x * SHAPE[1] + y) * SHAPE[2] + z]!;
        if (!isOccupied(label) || !visible[label]) continue;
        const cell: Cell = [x, y, z];
        const spans = cell.map((c, i) => [(c - from[i]!) / direction[i]!, (c + 1 - from[i]!) / direction[i]!]);
        const enter = Math.max(0, ...spans.map((span) => Math.min(...span)));
        const leave = Math.min(...spans.map((span) => Math.max(...span)));
        if (enter < leave && (!best || enter < best.t)) best = { cell, t: enter };
      }
  return best;
}

describe("picking", () => {
  it("finds the cell that testing every cell finds", () => {
    const next = random(3);
    let hits = 0;
    for (let round = 0; round < 400; round++) {
      const labels = someScene(SHAPE, round, 0.1);
      const from = [0, 1, 2].map(() => next() * 40 - 15) as Vec3;
      const direction = SHAPE.map((side, i) => next() * side - from[i]!) as Vec3;
      const seeing = round % 3 ? seen() : seen({ low: [2, 1, 3], high: [8, 5, 6] });
      if (round % 5 === 0) seeing.visible = Array.from({ length: 256 }, (_, id) => id > 4 && id < 12);
      const found = pickCell({ labels, shape: SHAPE }, seeing, from, direction);
      const wanted = bruteForce(labels, seeing, from, direction);
      expect(found?.cell ?? null).toEqual(wanted?.cell ?? null);
      if (found) expect(found.t).toBeCloseTo(wanted!.t, 9);
      hits += found ? 1 : 0;
    }
    expect(hits).toBeGreaterThan(100);
  });

  it("says which side the ray came in through", () => {
    const labels = new Uint8Array(9 * 7 * 8);
    labels[(4 * 7 + 3) * 8 + 2] = 5;
    const ahead: Vec3[] = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]];
    ahead.forEach((normal, face) => {
      const from = [4.5, 3.5, 2.5].map((c, i) => c + 20 * normal[i]!) as Vec3;
      const hit = pickCell({ labels, shape: SHAPE }, seen(), from, normal.map((n) => -n) as Vec3);
      expect(hit?.face).toBe(face);
      expect(hit?.t).toBeCloseTo(19.5);
    });
  });

  it("walks neighbours only, from a start inside as well", () => {
    const cells: Cell[] = [];
    walkRay(seen(), [4.2, 3.3, 2.9], [0.3, -0.2, 0.4], (cell) => {
      cells.push([...cell]);
      return false;
    });
    expect(cells[0]).toEqual([4, 3, 2]);
    cells.slice(1).forEach((cell, i) => {
      expect(cell.reduce((sum, c, axis) => sum + Math.abs(c - cells[i]![axis]!), 0)).toBe(1);
    });
  });

  it("does not get stuck or lost far away", () => {
    const labels = new Uint8Array(9 * 7 * 8).fill(3);
    const from: Vec3 = [1e5 + 0.1, 0.3e5, 0.2e5];
    const direction = from.map((value, i) => SHAPE[i]! / 2 - value) as Vec3;
    expect(pickCell({ labels, shape: SHAPE }, seen(), from, direction)?.face).toBe(0);
  });

  it("finds nothing in a box without cells", () => {
    const labels = new Uint8Array(9 * 7 * 8).fill(3);
    const empty = seen({ low: [3, 3, 3], high: [3, 7, 8] });
    expect(pickCell({ labels, shape: SHAPE }, empty, [4, 4, -3], [0, 0, 1])).toBeNull();
  });
});
