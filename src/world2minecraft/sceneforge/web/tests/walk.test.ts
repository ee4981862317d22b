import { describe, expect, it } from "vitest";

// The same file that tests/minecraft/physics/ holds the Python to.
import golden from "../../../../../tests/minecraft/physics/golden.json?raw";
import { bodyAt, NO_KEYS, type Box, type Keys } from "../src/walk/body";
import { step } from "../src/walk/physics";
import { BlockWorld, BoxWorld } from "../src/walk/world";
import type { Vec3 } from "../src/wire";

interface Case {
  name: string;
  scale: number;
  start: Vec3;
  boxes: Box[];
  keys: { ticks: number; down: (keyof Keys)[]; yaw_deg: number }[];
  path: number[][];
}

const CASES = JSON.parse(golden) as Case[];
const EVERY = 4;

function walked(one: Case): number[][] {
  const world = new BoxWorld(one.boxes);
  const ticks = one.keys.reduce((sum, spell) => sum + spell.ticks, 0);
  const path: number[][] = [];
  let body = bodyAt(one.start);
  let tick = 0;
  for (const spell of one.keys) {
    const keys = { ...NO_KEYS, ...Object.fromEntries(spell.down.map((key) => [key, true])) };
    for (let count = 0; count < spell.ticks; count++) {
      body = step(world, body, keys, spell.yaw_deg, one.scale);
      tick += 1;
      if (tick % EVERY && tick !== ticks) continue;
      const flags = [body.onGround, body.crouched, body.hitWall].map(Number);
      path.push([...body.position, ...body.velocity, ...flags]);
    }
  }
  return path;
}

describe("walking", () => {
  it.each(CASES.map((one) => [one.name, one] as const))("%s, as in Python", (_, one) => {
    const path = walked(one);
    expect(path.length).toBe(one.path.length);
    path.forEach((row, at) =>
      row.forEach((value, column) => expect(value).toBeCloseTo(one.path[at]![column]!, 7)),
    );
  });

  it("meets the boxes of cells where they are", () => {
    const kinds = new Uint8Array(2 * 3 * 2);
    kinds[(1 * 3 + 0) * 2 + 1] = 1; // a fence at 1, 0, 1
    const world = new BlockWorld(kinds, [2, 3, 2], [[], [[0.375, 0, 0.375, 0.625, 1.5, 0.625]]]);
    expect(world.near([1, 1.2, 1], [2, 2, 2])).toEqual([[1.375, 0, 1.375, 1.625, 1.5, 1.625]]);
    expect(world.near([-9, -9, -9], [0.9, 9, 9])).toEqual([]);
    expect(world.near([5, 5, 5], [9, 9, 9])).toEqual([]);
  });
});
