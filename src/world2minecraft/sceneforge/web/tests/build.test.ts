import { describe, expect, it } from "vitest";

import { BlockMesh, CEILING_CUT, cutsFrom, PARTITION_CUT } from "../src/build/mesh";
import { Packet } from "../src/build/packet";
import { describe as inWords } from "../src/build/words";

type Arrays = Record<string, { dtype: string; shape: number[]; data: Uint8Array }>;

/** What rendering/mesh/packets.py packs, written a second time. */
function packed(magic: string, told: object, arrays: Arrays): ArrayBuffer {
  const rows: Record<string, object> = {};
  let offset = 0;
  for (const [name, { dtype, shape, data }] of Object.entries(arrays)) {
    rows[name] = { dtype, shape, offset };
    offset += Math.ceil(data.length / 8) * 8;
  }
  let text = JSON.stringify({ ...told, arrays: rows });
  while ((text.length + 8) % 8) text += " ";
  const bytes = new Uint8Array(8 + text.length + offset);
  bytes.set(new TextEncoder().encode(magic));
  new DataView(bytes.buffer).setUint32(4, text.length, true);
  bytes.set(new TextEncoder().encode(text), 8);
  let at = 8 + text.length;
  for (const { data } of Object.values(arrays)) {
    bytes.set(data, at);
    at += Math.ceil(data.length / 8) * 8;
  }
  return bytes.buffer;
}

const raw = (values: Float32Array | Uint16Array | Uint8Array): Uint8Array => new Uint8Array(values.buffer);

/** Two faces that look to -x: at x = 2 of class 3 with cut 1, at x = 5 of class 8 and object 7. */
function wall(cover = 65535): BlockMesh {
  const face = (x: number): number[] => [x, 0, 0, x, 0, 3, x, 3, 3, x, 3, 0];
  const corners = (of: (quad: number) => number[]): number[] => [0, 1].flatMap((q) => [0, 1, 2, 3].flatMap(() => of(q)));
  const entry = (dtype: string, shape: number[], values: Float32Array | Uint16Array | Uint8Array) => ({ dtype, shape, data: raw(values) });
  const kinds = [[0, 3 + 256, 65535, 0], [0, 8, cover, 0]];
  return BlockMesh.read(
    packed("W2MB", { palette: ["minecraft:air", "minecraft:stone"], clear_from: 2, texture_px: 1 }, {
      position: entry("f4", [8, 3], new Float32Array([...face(2), ...face(5)])),
      uv: entry("f4", [8, 2], new Float32Array(16)),
      light: entry("u1", [8, 4], new Uint8Array(32)),
      colour: entry("u1", [8, 4], new Uint8Array(32)),
      kind: entry("u2", [8, 4], new Uint16Array(corners((q) => kinds[q]!))),
      state: entry("u2", [2], new Uint16Array([1, 1])),
      instance: entry("u2", [2], new Uint16Array([0, 7])),
      texels: entry("u1", [1, 1, 1, 4], new Uint8Array(4)),
    }),
  );
}

const NOTHING = { classes: 0, cuts: 0 };

describe("the mesh of a build", () => {
  it("is met at the first face that is drawn, in the block behind it", () => {
    const mesh = wall();
    expect(mesh.meet([0, 1.5, 1.5], [1, 0, 0], NOTHING)).toEqual({ quad: 0, t: 2, cell: [2, 1, 1] });
    expect(mesh.meet([0, 1.5, 1.5], [2, 0, 0], { classes: 1 << 3, cuts: 0 })).toEqual({ quad: 1, t: 2.5, cell: [5, 1, 1] });
    expect(mesh.meet([0, 1.5, 1.5], [1, 0, 0], { classes: 0, cuts: 1 })?.quad).toBe(1);
    expect(mesh.meet([0, 1.5, 1.5], [1, 0, 0], { classes: (1 << 3) | (1 << 8), cuts: 0 })).toBeNull();
  });

  it("is met from the front alone, within its faces, and ahead", () => {
    const mesh = wall();
    expect(mesh.meet([9, 1.5, 1.5], [-1, 0, 0], NOTHING)).toBeNull();
    expect(mesh.meet([0, 3.01, 1.5], [1, 0, 0], NOTHING)).toBeNull();
    expect(mesh.meet([3, 1.5, 1.5], [1, 0, 0], NOTHING)?.quad).toBe(1);
  });

  it("shows what lies under something only where that is hidden", () => {
    const mesh = wall(2 + 2 * 256);
    expect(mesh.meet([3, 1.5, 1.5], [1, 0, 0], NOTHING)).toBeNull();
    expect(mesh.meet([3, 1.5, 1.5], [1, 0, 0], { classes: 1 << 2, cuts: 0 })?.quad).toBe(1);
    expect(mesh.meet([3, 1.5, 1.5], [1, 0, 0], { classes: 0, cuts: 2 })?.quad).toBe(1);
  });

  it("knows the box of an object", () => {
    expect(wall().boxOf(7)).toEqual({ low: [5, 0, 0], high: [5, 3, 3] });
    expect(wall().boxOf(8)).toBeNull();
  });

  it("is opened on the sides that are near, which room y turns round", () => {
    const sides = [[-1, 1], [-1, -1], [1, 1], [1, -1]] as const; // block (x, z): --, -+, +-, ++
    sides.forEach(([x, y], bit) => expect(cutsFrom([x, y, 1])).toBe((1 << bit) | PARTITION_CUT));
    expect(CEILING_CUT).toBe(16);
  });
});

describe("packed arrays", () => {
  it("are refused where they are something else", () => {
    expect(() => Packet.read(packed("W2MC", {}, {}), "W2MB")).toThrow("not W2MB");
    expect(() => Packet.read(packed("W2MC", {}, {}), "W2MC").array("boxes")).toThrow("no array boxes");
  });
});

describe("a block in words", () => {
  it("has a name, an id and what is special about it", () => {
    expect(inWords("minecraft:oak_stairs[facing=east,half=top,waterlogged=false]")).toEqual({
      name: "Oak stairs",
      id: "minecraft:oak_stairs",
      facts: [["facing", "east"], ["half", "top"]],
    });
    expect(inWords("minecraft:stone").facts).toEqual([]);
    expect(inWords("").id).toBe("minecraft:block_display");
  });
});
