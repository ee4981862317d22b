import { describe, expect, it } from "vitest";

import { CHUNK, meshChunk, type ChunkMesh, type Style } from "../src/view/mesher";
import { UNKNOWN } from "../src/view/volume";
import type { Vec3 } from "../src/wire";
import { someScene } from "./scenes";

const AHEAD: Vec3[] = [
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, 1],
  [-1, 0, 0],
  [0, -1, 0],
  [0, 0, -1],
];

/** Slow and readable: every side of a cell beyond which another label lies, as "face x y z label". */
function facesOf(labels: Uint8Array, [X, Y, Z]: Vec3): string[] {
  const at = (x: number, y: number, z: number) => {
    const inside = x >= 0 && y >= 0 && z >= 0 && x < X && y < Y && z < Z;
    const label = inside ? labels[(x * Y + y) * Z + z]! : 0;
    return label === UNKNOWN ? 0 : label;
  };
  const faces: string[] = [];
  for (let x = 0; x < X; x++)
    for (let y = 0; y < Y; y++)
      for (let z = 0; z < Z; z++)
        AHEAD.forEach(([dx, dy, dz], face) => {
          const label = at(x, y, z);
          if (label && at(x + dx, y + dy, z + dz) !== label) faces.push(`${face} ${x} ${y} ${z} ${label}`);
        });
  return faces.sort();
}

interface Quad {
  face: number;
  label: number;
  step: number;
  corners: Vec3[];
}

function quadsOf({ words, starts }: ChunkMesh, low: Vec3, style: Style): Quad[] {
  const quads: Quad[] = [];
  for (let quad = 0; quad < words.length / 8; quad++) {
    const corners = [0, 1, 2, 3].map((corner): Vec3 => {
      const word = words[quad * 8 + corner * 2]!;
      const bits = (word >>> 27) & 7;
      const cell = [word & 255, (word >>> 8) & 255, (word >>> 16) & 255];
      return cell.map((c, i) => low[i]! + c + (style === "cubes" ? (bits >> i) & 1 : 0)) as Vec3;
    });
    const face = (words[quad * 8]! >>> 24) & 7;
    expect(quad).toBeGreaterThanOrEqual(starts[face]!);
    expect(quad).toBeLessThan(starts[face + 1]!);
    quads.push({ face, label: words[quad * 8 + 1]! & 255, step: words[quad * 8 + 1]! >>> 8, corners });
  }
  return quads;
}

function meshAll(labels: Uint8Array, shape: Vec3, step = 1, style: Style = "greedy"): Quad[] {
  const quads: Quad[] = [];
  for (let x = 0; x < shape[0]; x += CHUNK)
    for (let y = 0; y < shape[1]; y += CHUNK)
      for (let z = 0; z < shape[2]; z += CHUNK)
        quads.push(...quadsOf(meshChunk(labels, shape, [x, y, z], step, style), [x, y, z], style));
  return quads;
}

/** The sides of cells that quads cover, as facesOf names them. */
function covered(quads: Quad[]): string[] {
  const faces: string[] = [];
  for (const { face, label, corners } of quads) {
    const axis = face % 3;
    const low = [0, 1, 2].map((i) => Math.min(...corners.map((c) => c[i]!))) as Vec3;
    const high = [0, 1, 2].map((i) => Math.max(...corners.map((c) => c[i]!))) as Vec3;
    expect(low[axis]).toBe(high[axis]);
    if (face < 3) low[axis]! -= 1;
    high[axis] = low[axis]! + 1;
    for (let x = low[0]; x < high[0]; x++)
      for (let y = low[1]; y < high[1]; y++)
        for (let z = low[2]; z < high[2]; z++) faces.push(`${face} ${x} ${y} ${z} ${label}`);
  }
  return faces.sort();
}

function normalOf([a, b, c]: Vec3[]): Vec3 {
  const [p, q] = [b!.map((v, i) => v - a![i]!), c!.map((v, i) => v - a![i]!)] as [Vec3, Vec3];
  return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
}

describe("greedy mesh", () => {
  it.each([
    [[5, 4, 3], 1],
    [[32, 32, 32], 2],
    [[33, 31, 34], 3],
    [[70, 9, 40], 4],
    [[1, 1, 1], 5],
  ] as [Vec3, number][])("covers each boundary face of a %j scene once", (shape, seed) => {
    const labels = someScene(shape, seed);
    expect(covered(meshAll(labels, shape))).toEqual(facesOf(labels, shape));
  });

  it("turns each quad outwards", () => {
    const shape: Vec3 = [20, 21, 22];
    const labels = someScene(shape, 7);
    for (const style of ["greedy", "cubes"] as const) {
      for (const { face, corners } of meshAll(labels, shape, 1, style)) {
        expect(normalOf(corners).map(Math.sign).map((v) => v + 0)).toEqual(AHEAD[face]!.map((v) => v + 0));
      }
    }
  });

  it("tells of each corner on which side of its quad it lies", () => {
    const shape: Vec3 = [20, 21, 22];
    const { words } = meshChunk(someScene(shape, 8), shape, [0, 0, 0]);
    for (let quad = 0; quad < words.length; quad += 8) {
      const four = [0, 2, 4, 6].map((at) => words[quad + at]!);
      const axis = ((four[0]! >>> 24) & 7) % 3;
      for (const side of [0, 1, 2].filter((other) => other !== axis)) {
        const places = four.map((word) => (word >>> (8 * side)) & 255);
        const high = four.map((word) => ((word >>> (27 + side)) & 1) === 1);
        expect(high).toEqual(places.map((place) => place === Math.max(...places)));
      }
    }
  });

  it("gives a box six quads, and a box of two classes ten and the two between", () => {
    const shape: Vec3 = [30, 30, 30];
    const labels = new Uint8Array(27000);
    for (let x = 5; x < 15; x++)
      for (let y = 5; y < 15; y++) labels.fill(3, (x * 30 + y) * 30 + 5, (x * 30 + y) * 30 + 15);
    expect(meshAll(labels, shape)).toHaveLength(6);
    for (let x = 5; x < 10; x++)
      for (let y = 5; y < 15; y++) labels.fill(4, (x * 30 + y) * 30 + 5, (x * 30 + y) * 30 + 15);
    expect(meshAll(labels, shape)).toHaveLength(12);
  });

  it("needs far fewer quads than faces in a plain scene", () => {
    const shape: Vec3 = [32, 32, 32];
    const labels = someScene(shape, 11, 0);
    expect(meshAll(labels, shape).length).toBeLessThan(facesOf(labels, shape).length / 10);
  });
});

describe("cubes", () => {
  it("give the six sides of each cell that shows one, and of no other", () => {
    const shape: Vec3 = [12, 34, 11];
    const labels = someScene(shape, 9);
    const shown = new Set(facesOf(labels, shape).map((face) => face.slice(2)));
    const wanted = [...shown].flatMap((cell) => AHEAD.map((_, face) => `${face} ${cell}`)).sort();
    expect(covered(meshAll(labels, shape, 1, "cubes"))).toEqual(wanted);
  });
});

describe("coarse mesh", () => {
  it("is that of the blocks, closed at the chunk's sides", () => {
    const shape: Vec3 = [37, 20, 33];
    const labels = someScene(shape, 12);
    for (const step of [2, 4]) {
      for (const { corners, step: told } of meshAll(labels, shape, step)) {
        expect(told).toBe(step);
        expect(corners.flat().every((value) => value % step === 0)).toBe(true);
      }
    }
  });

  it("leaves out no cell and no part of a chunk", () => {
    const shape: Vec3 = [32, 32, 32];
    const labels = new Uint8Array(32 ** 3);
    labels[(9 * 32 + 10) * 32 + 11] = 5;
    const quads = meshAll(labels, shape, 4);
    expect(quads).toHaveLength(6);
    expect(quads.flatMap(({ corners }) => corners.map((c) => c[0]))).toContain(8);
    expect(meshAll(new Uint8Array(32 ** 3).fill(2), shape, 4)).toHaveLength(6);
  });
});
