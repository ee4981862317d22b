import { describe, expect, it } from "vitest";

import { axesOf, between, dot, eyeOf, fitted, panned, plus, rayAt, shortWay, turned, zoomed, type Orbit } from "../src/view/camera";
import { Sight } from "../src/view/sight";
import type { Vec3 } from "../src/wire";

const W = 1280;
const H = 720;

function orbit(change: Partial<Orbit> = {}): Orbit {
  return { target: [1, 2, 0.5], azimuth: -2.1, elevation: 0.6, distance: 7, ortho: false, ...change };
}

function sightOf(one: Orbit): Sight {
  const sight = new Sight(one);
  sight.resize(W, H);
  return sight;
}

describe.each([false, true])("camera, parallel %s", (ortho) => {
  it("has three unit vectors at right angles, right-handed", () => {
    const { back, right, up } = axesOf(orbit({ ortho }));
    for (const axis of [back, right, up]) expect(dot(axis, axis)).toBeCloseTo(1);
    expect(dot(back, right)).toBeCloseTo(0);
    expect(dot(back, up)).toBeCloseTo(0);
    const cross: Vec3 = [
      right[1] * up[2] - right[2] * up[1],
      right[2] * up[0] - right[0] * up[2],
      right[0] * up[1] - right[1] * up[0],
    ];
    cross.forEach((value, i) => expect(value).toBeCloseTo(back[i]!));
    expect(up[2]).toBeGreaterThan(0);
  });

  it("projects each point of a ray to the pixel of the ray", () => {
    const sight = sightOf(orbit({ ortho }));
    for (const [x, y] of [[10, 20], [640, 360], [1270, 700]] as const) {
      const { from, direction } = sight.ray(x, y);
      const lengthen = ortho ? 1000 : 3;
      const [px, py] = sight.project(plus(from, direction, lengthen))!;
      expect(px).toBeCloseTo(x, 3);
      expect(py).toBeCloseTo(y, 3);
    }
  });

  it("agrees with three.js's camera", () => {
    const sight = sightOf(orbit({ ortho }));
    const camera = sight.camera();
    const point: Vec3 = [0.2, 1.1, 1.4];
    const m = camera.projectionMatrix.clone().multiply(camera.matrixWorldInverse).elements;
    const clip = [0, 1, 3].map((row) => m[row]! * point[0] + m[row + 4]! * point[1] + m[row + 8]! * point[2] + m[row + 12]!);
    const [x, y] = sight.project(point)!;
    expect(((clip[0]! / clip[2]! + 1) / 2) * W).toBeCloseTo(x, 4);
    expect(((1 - clip[1]! / clip[2]!) / 2) * H).toBeCloseTo(y, 4);
  });

  it("has the whole of a box in view, and not much more", () => {
    const low: Vec3 = [-1, 0, 0];
    const high: Vec3 = [4, 6, 2.6];
    const sight = sightOf(fitted(orbit({ ortho }), low, high, W / H));
    let widest = 0;
    for (let corner = 0; corner < 8; corner++) {
      const at = [0, 1, 2].map((i) => ((corner >> i) & 1 ? high[i]! : low[i]!)) as Vec3;
      const [x, y] = sight.project(at)!;
      expect(x > 0 && x < W && y > 0 && y < H).toBe(true);
      widest = Math.max(widest, Math.abs(x / W - 0.5), Math.abs(y / H - 0.5));
    }
    expect(widest).toBeGreaterThan(0.42);
  });

  it("zooms to a point without moving it on the screen", () => {
    const one = orbit({ ortho });
    const { from, direction } = rayAt(one, 900, 200, W, H);
    const point = plus(from, direction, ortho ? 998 : 5);
    for (const factor of [0.5, 1.7]) {
      const [x, y] = sightOf(zoomed(one, factor, point)).project(point)!;
      expect(x).toBeCloseTo(900, 4);
      expect(y).toBeCloseTo(200, 4);
    }
  });

  it("pans what lies at the target with the pointer", () => {
    const one = orbit({ ortho });
    const [x, y] = sightOf(panned(one, 0.25, -0.5)).project(one.target)!;
    expect(x).toBeCloseTo(W / 2 + 0.25 * H);
    expect(y).toBeCloseTo(H / 2 + 0.5 * H);
  });
});

describe("orbit", () => {
  it("turns round the target and never over the top", () => {
    const one = turned(orbit(), 1, 10);
    expect(Math.hypot(...plus(eyeOf(one), one.target, -1))).toBeCloseTo(7);
    expect(one.elevation).toBeLessThan(Math.PI / 2);
    expect(turned(one, 0, -20).elevation).toBeGreaterThan(-Math.PI / 2);
  });

  it("flies from where it was to where it shall be, the short way round", () => {
    const [from, to] = [orbit({ azimuth: 3 }), orbit({ azimuth: -3, distance: 2 })];
    expect(between(from, to, 0)).toEqual(from);
    const end = between(from, to, 1);
    expect(shortWay(end.azimuth - to.azimuth)).toBeCloseTo(0);
    expect(end.distance).toBeCloseTo(2);
    expect(Math.abs(shortWay(between(from, to, 0.5).azimuth - Math.PI))).toBeLessThan(0.01);
  });

  it("puts nothing on the screen that lies behind", () => {
    const one = orbit();
    expect(sightOf(one).project(plus(eyeOf(one), axesOf(one).back, 1))).toBeNull();
  });
});

describe("pose", () => {
  it("looks where it is told, with a ray and a point that agree", () => {
    const sight = sightOf(orbit());
    sight.pose = { position: [1, 1, 1.6], forward: [0.6, 0.8, 0], up: [0, 0, 1], field: 1 };
    expect(sight.project([1.6, 1.8, 1.6])!.map(Math.round)).toEqual([W / 2, H / 2]);
    const { from, direction } = sight.ray(100, 650);
    sight.project(plus(from, direction, 2))!.forEach((value, i) => expect(value).toBeCloseTo([100, 650][i]!));
    sight.pose = null;
    expect(sight.eye).toEqual(eyeOf(orbit()));
  });
});
