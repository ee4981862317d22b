import { describe, expect, it } from "vitest";

import { sideMatrix } from "../src/view/compass";
import { axesOf, type Orbit } from "../src/view/camera";
import { capQuads } from "../src/view/caps";
import { arrowCorners } from "../src/view/balls";
import { boxEdges } from "../src/view/markers";
import { facesOfCells } from "../src/view/overlay";
import { pickCell } from "../src/view/pick";
import { cellsInPolygon, inPolygon, type Point } from "../src/view/regions";
import { seenOf } from "../src/view/seen";
import { Sight } from "../src/view/sight";
import { cellOf, changedCells, flatOf, isOccupied, runsOf } from "../src/view/volume";
import { writeRuns } from "../src/changes";
import { Store } from "../src/store";
import type { HeldRun, Vec3 } from "../src/wire";
import { random, someScene } from "./scenes";

const SHAPE: Vec3 = [11, 9, 10];

function view(change = {}) {
  return { ...new Store().get().view, hidden: new Set<number>(), ...change };
}

describe("what is drawn", () => {
  it("is all but empty, unknown and hidden classes, or one class alone", () => {
    const { visible } = seenOf(view({ hidden: new Set([1, 4]) }), SHAPE);
    expect([0, 1, 3, 4, 255].map((id) => visible[id])).toEqual([false, false, true, false, false]);
    const alone = seenOf(view({ hidden: new Set([7]), solo: 7 }), SHAPE).visible;
    expect([3, 7].map((id) => alone[id])).toEqual([false, true]);
  });

  it("lies in the slice and in the section box", () => {
    const { low, high } = seenOf(
      view({ slice: { axis: 2, low: 3, high: 5 }, section: { low: [1, 2, 0], high: [6, 7, 4] } }),
      SHAPE,
    );
    expect([low, high]).toEqual([[1, 2, 3], [7, 8, 5]]);
  });
});

describe("cells", () => {
  it("have numbers that tell where they are", () => {
    for (let flat = 0; flat < 11 * 9 * 10; flat++) expect(flatOf(SHAPE, ...cellOf(SHAPE, flat))).toBe(flat);
  });

  it("become the runs that name each of them once", () => {
    const next = random(4);
    const flats = Array.from({ length: 300 }, () => Math.floor(next() * 500));
    const runs = runsOf(flats);
    const named = runs.flatMap(([first, length]) => Array.from({ length }, (_, i) => first + i));
    expect(named).toEqual([...new Set(flats)].sort((a, b) => a - b));
    expect(runs.every(([first], i) => i === 0 || first > runs[i - 1]![0] + runs[i - 1]![1])).toBe(true);
  });

  it("that differ are those that a change names", () => {
    const labels = someScene(SHAPE, 5);
    const copy = labels.slice();
    const held: HeldRun[] = [[17, 4, 12, 3, 200], [400, 1, 13, 0, 0]];
    writeRuns(held, labels, new Uint16Array(990), new Uint8Array(990));
    expect(changedCells(copy, labels)).toEqual([17, 18, 19, 20, 400]);
    expect(copy).toEqual(labels);
    expect(changedCells(copy, labels)).toEqual([]);
  });
});

describe("caps", () => {
  it("close each cut face that the mesh leaves open, once", () => {
    const labels = someScene(SHAPE, 21, 0.1);
    const box = { low: [2, 0, 3] as Vec3, high: [9, 6, 10] as Vec3 };
    const found: string[] = [];
    const words = capQuads(labels, SHAPE, box);
    for (let at = 0; at < words.length; at += 32) {
      const corners = [0, 8, 16, 24].map((i) => [...words.subarray(at + i, at + i + 3)] as Vec3);
      const face = words[at + 3]! & 7;
      const low = [0, 1, 2].map((i) => Math.min(...corners.map((c) => c[i]!)));
      const high = [0, 1, 2].map((i) => Math.max(...corners.map((c) => c[i]!)));
      if (face < 3) low[face]! -= 1;
      high[face % 3] = low[face % 3]! + 1;
      for (let x = low[0]!; x < high[0]!; x++)
        for (let y = low[1]!; y < high[1]!; y++)
          for (let z = low[2]!; z < high[2]!; z++) found.push(`${face} ${x} ${y} ${z} ${words[at + 4]}`);
    }
    expect(found.sort()).toEqual(openFaces(labels, box).sort());
  });

  it("are none where nothing is cut, or nothing left", () => {
    const labels = new Uint8Array(990).fill(3);
    expect(capQuads(labels, SHAPE, { low: [0, 0, 0], high: SHAPE })).toHaveLength(0);
    expect(capQuads(labels, SHAPE, { low: [4, 4, 4], high: [4, 9, 9] })).toHaveLength(0);
  });
});

/** Slow and readable: faces of the box's outermost cells with the same label beyond them. */
function openFaces(labels: Uint8Array, { low, high }: { low: Vec3; high: Vec3 }): string[] {
  const faces: string[] = [];
  const inside = (cell: Vec3) => cell.every((c, i) => c >= low[i]! && c < high[i]!);
  for (let flat = 0; flat < labels.length; flat++) {
    const cell = cellOf(SHAPE, flat);
    if (!inside(cell) || !isOccupied(labels[flat]!)) continue;
    for (let face = 0; face < 6; face++) {
      const beyond = cell.map((c, i) => (i === face % 3 ? c + (face < 3 ? 1 : -1) : c)) as Vec3;
      const exists = beyond.every((c, i) => c >= 0 && c < SHAPE[i]!);
      if (!exists || inside(beyond) || labels[flatOf(SHAPE, ...beyond)] !== labels[flat]) continue;
      faces.push(`${face} ${cell.join(" ")} ${labels[flat]}`);
    }
  }
  return faces;
}

describe("overlay", () => {
  it("says for each corner how light it is", () => {
    const { corners, lights } = facesOfCells([[0, 5]], SHAPE);
    expect(lights.length / 4).toBe(corners.length / 3);
  });

  it("has a face on each outer side of its cells and none between them", () => {
    const one = flatOf(SHAPE, 4, 4, 4);
    expect(facesOfCells([[one, 1]], SHAPE).corners).toHaveLength(6 * 12);
    expect(facesOfCells([[one, 2]], SHAPE).corners).toHaveLength(10 * 12);
    expect(facesOfCells([[0, 11 * 9 * 10]], SHAPE).corners).toHaveLength(2 * (99 + 110 + 90) * 12);
  });
});

describe("regions of the screen", () => {
  const square: Point[] = [[0, 0], [10, 0], [10, 10], [0, 10]];

  it("count crossed sides", () => {
    expect(inPolygon([5, 5], square)).toBe(true);
    expect(inPolygon([15, 5], square)).toBe(false);
    const notched: Point[] = [...square.slice(0, 3), [5, 5], [0, 10]];
    expect(inPolygon([5, 8], notched)).toBe(false);
  });

  it("reach the surface, some cells deep, or through", () => {
    // Seen along -z from above, one pixel a cell: a tower of five cells and a gap in it.
    const labels = new Uint8Array(990);
    for (const z of [0, 1, 2, 4, 5]) labels[flatOf(SHAPE, 3, 3, z)] = 5;
    const seen = seenOf(view(), SHAPE);
    const chosen = (limit: "surface" | "through" | number) =>
      cellsInPolygon({ labels, shape: SHAPE }, seen, square, limit, ([x, y]) => [x, y], (x, y) => ({
        from: [x, y, 100],
        direction: [0, 0, -1],
      })).map((flat) => cellOf(SHAPE, flat)[2]);
    expect(chosen("surface")).toEqual([5]);
    expect(chosen(1)).toEqual([4, 5]);
    expect(chosen(2)).toEqual([2, 4, 5]);
    expect(chosen("through")).toEqual([0, 1, 2, 4, 5]);
  });

  it("of the surface are the cells that rays through their pixels meet", () => {
    const sight = new Sight({ target: [5, 4, 4], azimuth: -2, elevation: 0.6, distance: 30, ortho: false });
    sight.resize(400, 300);
    const labels = someScene(SHAPE, 33, 0.02);
    const seen = seenOf(view(), SHAPE);
    const volume = { labels, shape: SHAPE };
    const whole: Point[] = [[0, 0], [400, 0], [400, 300], [0, 300]];
    const flats = cellsInPolygon(volume, seen, whole, "surface", sight.projector(), (x, y) => sight.ray(x, y));
    const met = new Set<number>();
    for (let y = 1; y < 300; y += 2)
      for (let x = 1; x < 400; x += 2) {
        const { from, direction } = sight.ray(x, y);
        const hit = pickCell(volume, seen, from, direction);
        if (hit) met.add(hit.flat);
      }
    expect(flats).toEqual([...met].sort((a, b) => a - b));
    const through = cellsInPolygon(volume, seen, whole, "through", sight.projector(), (x, y) => sight.ray(x, y));
    expect(through.length).toBe(labels.filter(isOccupied).length);
    expect(flats.length).toBeLessThan(through.length);
  });

  it("leave out what is hidden or cut away", () => {
    const labels = new Uint8Array(990).fill(5);
    const all = (change: object) =>
      cellsInPolygon({ labels, shape: SHAPE }, seenOf(view(change), SHAPE), square, "through", ([x, y]) => [x, y], () => ({
        from: [0, 0, 0],
        direction: [0, 0, 1],
      })).length;
    expect(all({ hidden: new Set([5]) })).toBe(0);
    expect(all({ slice: { axis: 2, low: 0, high: 1 } })).toBe(10 * 9 * 2);
  });
});

describe("marks of objects", () => {
  it("have twelve edges of the box's lengths, turned about z", () => {
    const edges = boxEdges([1, 2, 3], [4, 2, 1], Math.PI / 2);
    const lengths = Array.from({ length: 12 }, (_, i) =>
      Math.hypot(...[0, 1, 2].map((axis) => edges[6 * i + axis]! - edges[6 * i + 3 + axis]!)),
    );
    expect(lengths.map((length) => Math.round(length * 1e6) / 1e6).sort()).toEqual([1, 1, 1, 1, 2, 2, 2, 2, 4, 4, 4, 4]);
    const wide = (axis: number) => Math.max(...edges.filter((_, i) => i % 3 === axis));
    expect([wide(0), wide(1), wide(2)].map((v) => Math.round(v * 1e6) / 1e6)).toEqual([2, 4, 3.5]);
  });

  it("point where the front looks: 0 along +x, counter-clockwise from above", () => {
    for (const [yaw, ahead] of [[0, [1, 0]], [Math.PI / 2, [0, 1]]] as const) {
      const [tip] = arrowCorners([0, 0, 1], yaw, 0.1);
      expect(tip![0] * ahead[0] + tip![1] * ahead[1]).toBeGreaterThan(0.2);
      expect(tip![2]).toBe(1);
    }
  });
});

describe("compass", () => {
  const orbit: Orbit = { target: [0, 0, 0], azimuth: -2.1, elevation: 0.7, distance: 5, ortho: false };

  it("shows three sides, each readable from outside", () => {
    const matrices = [0, 1, 2, 3, 4, 5].map((side) => sideMatrix(side, axesOf(orbit)));
    expect(matrices.map((m) => m !== null)).toEqual([false, false, true, true, true, false]);
    for (const m of matrices) if (m) expect(m[0]! * m[3]! - m[1]! * m[2]!).toBeGreaterThan(0); // not mirrored
  });

  it("shows one side alone from in front of it, words level", () => {
    const front = sideMatrix(4, axesOf({ ...orbit, azimuth: -Math.PI / 2, elevation: 0 }))!;
    [1, 0, 0, 1, 0, 0].forEach((value, i) => expect(front[i]).toBeCloseTo(value));
  });
});
