import { describe, expect, it } from "vitest";

import { expanded } from "../src/build/compact";
import { Packet } from "../src/build/packet";
import type { Thing } from "../src/share/data";
import { distance, findThing, subjectOf } from "../src/share/finder";
import { snug } from "../src/share/snug";
import { Ways } from "../src/share/ways";
import { axesOf, eyeOf, FIELD } from "../src/view/camera";
import { Led } from "../src/walk/led";
import { Route, yawTo } from "../src/walk/route";
import { keysOfStick } from "../src/walk/thumbs";
import type { Walker } from "../src/walk/walker";
import type { Vec3 } from "../src/wire";

type Rows = Record<string, { dtype: string; shape: number[]; data: Uint8Array }>;

/** What rendering/mesh/packets.py packs. */
function packed(told: object, arrays: Rows): Packet {
  const rows: Record<string, object> = {};
  let offset = 0;
  for (const [name, { dtype, shape, data }] of Object.entries(arrays)) {
    rows[name] = { dtype, shape, offset };
    offset += Math.ceil(data.length / 8) * 8;
  }
  const text = new TextEncoder().encode(JSON.stringify({ ...told, arrays: rows }).padEnd(8 * 200));
  const bytes = new Uint8Array(8 + text.length + offset);
  bytes.set(new TextEncoder().encode("W2MS"));
  new DataView(bytes.buffer).setUint32(4, text.length, true);
  bytes.set(text, 8);
  Object.values(arrays).forEach(({ data }, i) => bytes.set(data, 8 + text.length + (Object.values(rows)[i] as { offset: number }).offset));
  return Packet.read(bytes.buffer, "W2MS");
}

const raw = (dtype: string, shape: number[], values: Float32Array | Uint16Array | Uint8Array) => ({ dtype, shape, data: new Uint8Array(values.buffer) });

/** Numbers of 32 bits, [rows, columns], as four planes of bytes. */
function planes(rows: number[][], unit: number): Uint8Array {
  const bytes = new Uint8Array(Int32Array.from(rows.flat().map((v) => v * unit)).buffer);
  return Uint8Array.from({ length: bytes.length }, (_, i) => bytes[(i % (bytes.length / 4)) * 4 + Math.floor(i / (bytes.length / 4))]!);
}

const thing = (id: number, name: string): Thing => ({ id, name, low_m: [0, 0, 0], high_m: [1, 1, 1], size_m: [1, 1, 1], way: id });

describe("the compact mesh", () => {
  it("has the corners, lights and kinds of each quad again", () => {
    const quads = [
      { first: [1, 2, 3], one: [0, -1.5, 0], two: [0, 0, 2] },
      { first: [-300, 0, 0.25], one: [1, 0, 0], two: [0, 1, 0] },
    ];
    const rows = (["first", "one", "two"] as const).flatMap((part) => [0, 1, 2].map((axis) => quads.map((quad) => quad[part][axis]!)));
    const lights = Uint8Array.from({ length: 26 }, (_, i) => i);
    const mesh = expanded(
      packed({ unit: 4, clear_from: 1 }, {
        corners: raw("u1", [4, 9, 2], planes(rows, 4)),
        uvs: raw("u1", [4, 6, 2], planes([[0, 1], [0, 2], [1, 0], [0, 0], [0, 0], [1, 1]], 4)),
        lights: raw("u1", [13, 2], lights),
        colours: raw("u1", [4, 2], Uint8Array.from([1, 2, 3, 4, 5, 6, 7, 8])),
        kinds_of_quads: raw("u2", [4, 2], Uint16Array.from([9, 10, 300, 400, 65535, 5, 0, 77])),
        texels: raw("u1", [1, 1, 1, 4], new Uint8Array(4)),
      }),
    );
    expect([...mesh.position.slice(0, 12)]).toEqual([1, 2, 3, 1, 0.5, 3, 1, 0.5, 5, 1, 2, 5]);
    expect([...mesh.position.slice(12, 18)]).toEqual([-300, 0, 0.25, -299, 0, 0.25]);
    expect([...mesh.uv.slice(8, 16)]).toEqual([1, 2, 1, 2, 1, 3, 1, 3]);
    expect([...mesh.light.slice(16, 24)]).toEqual([1, 3, 5, 25, 7, 9, 11, 25]);
    expect([...mesh.colour.slice(4, 8)]).toEqual([1, 3, 5, 7]);
    expect([...mesh.kind.slice(16, 20)]).toEqual([10, 400, 5, 0]);
    expect([...mesh.instance]).toEqual([0, 77]);
  });
});

describe("what a sentence names", () => {
  const things = [thing(1, "armchair"), thing(2, "lamp"), thing(3, "chair beside the desk"), thing(4, "desk")];
  const phrases = { armchair: [1], lamp: [2], chair: [1, 3], "chair beside the desk": [3], desk: [4], __proto__x: [4] };
  const find = (text: string) => findThing(text, phrases, things, ({ id }) => (id === 3 ? 1 : id === 1 ? 2 : 3));
  const named = (text: string) => (find(text) as { thing: Thing }).thing?.name;

  it("is the thing that it names last, and whole words only", () => {
    expect(named("Go to the LAMP!")).toBe("lamp");
    expect(named("past the lamp to the desk, please")).toBe("desk");
    expect(named("go to the chair beside the desk")).toBe("chair beside the desk");
    expect(named("deskjet")).toBeUndefined();
  });

  it("is the nearest of several", () => {
    expect(find("chair")).toEqual({ thing: things[2], of: 2 });
  });

  it("is answered by names that are alike, else by some", () => {
    expect(find("go to the lanp")).toEqual({ near: ["lamp"] });
    expect((find("fridge") as { near: string[] }).near).toHaveLength(4);
    expect(subjectOf("Where is the fridge?")).toBe("fridge");
    expect(distance("kitten", "sitting")).toBe(3);
  });
});

describe("the way to a thing", () => {
  // Four places in a row of 2 cells; way 0 ends at place 0, turning at 2; way 1 has none from 3.
  const feet = new Float32Array([0, 1, 0, 2, 1, 0, 4, 1, 0, 4, 1, 2]);
  const turns = new Uint16Array([0, 0, 0, 2, 1, 1, 1, 65535]);
  const ways = new Ways(packed({}, { feet_of_ways: raw("f4", [4, 3], feet), turns: raw("u2", [2, 4], turns) }));

  it("turns where the planner says, from the nearest place that has a way", () => {
    expect(ways.from([4, 1, 2.5], 0)).toEqual([[4, 1, 2.5], [4, 1, 2], [4, 1, 0], [0, 1, 0]]);
    expect(ways.from([4, 1, 2], 1)).toEqual([[4, 1, 2], [4, 1, 0], [2, 1, 0]]);
    expect(ways.from([0, 1, 0], -1)).toBeNull();
  });

  it("is gone along at a pace, looking ahead", () => {
    const route = new Route([[0, 0, 0], [0, 0, 4], [3, 0, 4]]);
    expect(route.length).toBe(7);
    expect(route.at(2)).toEqual({ place: [0, 0, 2], yawDeg: 0 });
    expect(route.at(5.5)).toEqual({ place: [1.5, 0, 4], yawDeg: -90 });
    expect(route.at(99).place).toEqual([3, 0, 4]);
    expect(route.crumbs(2)).toHaveLength(3);
    expect(yawTo([0, 0, 0], [1, 0, -1])).toBe(-135);
  });

  it("is walked gently, and ends facing what it leads to", () => {
    const walker = {
      yawDeg: 170,
      pitchDeg: 0,
      place: [0, 0, 0] as Vec3,
      put(place: Vec3, yawDeg: number, pitchDeg: number) {
        Object.assign(this, { place, yawDeg, pitchDeg });
      },
    };
    const led = new Led(new Route([[0, 0, 0], [0, 0, 8]]), [4, 0, 8], 4); // 2 m, then to the side
    const places: number[] = [0];
    let yaw = 170;
    while (!led.pass(walker as unknown as Walker, 16) && places.length < 1000) {
      expect(Math.abs(walker.yawDeg - yaw)).toBeLessThanOrEqual(220 * 0.016 + 1e-9);
      yaw = walker.yawDeg;
      places.push(walker.place[2]);
    }
    const steps = places.slice(1).map((place, i) => place - places[i]!);
    const fastest = Math.max(...steps);
    expect(fastest).toBeCloseTo(1.5 * 4 * 0.016, 6);
    expect(steps[0]).toBeLessThan(fastest / 5);
    expect(steps.every((step) => step >= 0)).toBe(true);
    expect(walker.place).toEqual([0, 0, 8]);
    expect(((walker.yawDeg % 360) + 360) % 360).toBeCloseTo(270, 0);
  });
});

describe("the whole room in view", () => {
  it("touches the margins on two sides and crosses none", () => {
    const points = Float32Array.from({ length: 300 }, (_, i) => Math.sin(i * i) * 3 + (i % 3));
    const margins = { left: 0.1, right: 0.05, top: 0.2, bottom: 0.1 };
    const start = { target: [0, 0, 0] as Vec3, azimuth: 0.7, elevation: 0.6, distance: 5, ortho: false };
    for (const aspect of [0.5, 1.7]) {
      const orbit = snug(start, points, aspect, margins);
      const [eye, { back, right, up }] = [eyeOf(orbit), axesOf(orbit)];
      const seen = Array.from({ length: 100 }, (_, at) => {
        const from = [0, 1, 2].map((i) => points[at * 3 + i]! - eye[i]!);
        const along = (axis: Vec3): number => axis.reduce((sum, v, i) => sum + v * from[i]!, 0);
        const deep = -along(back) * Math.tan(FIELD / 2);
        return [0.5 + along(right) / deep / aspect / 2, 0.5 - along(up) / deep / 2] as const;
      });
      const free = [Math.min(...seen.map(([x]) => x)) - 0.1, 0.95 - Math.max(...seen.map(([x]) => x)), Math.min(...seen.map(([, y]) => y)) - 0.2, 0.9 - Math.max(...seen.map(([, y]) => y))];
      for (const one of free) expect(one).toBeGreaterThan(-1e-6);
      expect(Math.min(free[0]! + free[1]!, free[2]! + free[3]!)).toBeLessThan(1e-6);
    }
  });
});

describe("a stick for a thumb", () => {
  it("walks in eight directions, and rests in the middle", () => {
    const held = (x: number, y: number): string[] => Object.entries(keysOfStick(x, y)).flatMap(([name, on]) => (on ? [name] : []));
    expect(held(0.1, 0.1)).toEqual([]);
    expect(held(0, -0.8)).toEqual(["forward"]);
    expect(held(0, -1)).toEqual(["forward", "sprint"]);
    expect(held(0.5, -0.5)).toEqual(["forward", "right"]);
    expect(held(-0.6, 0)).toEqual(["left"]);
    expect(held(-0.5, 0.5)).toEqual(["back", "left"]);
  });
});
