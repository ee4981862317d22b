// A photo's pose as a stand of the view: the same pixel sees the same ray.

import { describe, expect, it } from "vitest";

import { between, boxOf, orbitAt, poseOf, pyramids, type Frame } from "../src/photos/place";
import { axesOf, eyeOf } from "../src/view/camera";

/** A camera at (1, 2, 1.5) that looks along +x, level: its right is -y, its down is -z. */
const FRAME: Frame = {
  n: 0,
  name: "a",
  camera_to_room: [
    [0, 0, 1, 1],
    [-1, 0, 0, 2],
    [0, -1, 0, 1.5],
    [0, 0, 0, 1],
  ],
  vertical_fov_deg: 60,
  aspect: 4 / 3,
  is_depth: false,
};

describe("poseOf", () => {
  it("stands at the camera, looks where it looked, and has its up", () => {
    const pose = poseOf(FRAME, 2);
    expect(pose.position).toEqual([1, 2, 1.5]);
    expect(pose.forward).toEqual([1, 0, 0]);
    expect(pose.up.map((one) => one + 0)).toEqual([0, 0, 1]);
  });

  it("keeps the vertical field where the canvas is wider, and widens it where it is narrower", () => {
    expect(poseOf(FRAME, 2).field).toBeCloseTo(Math.PI / 3, 12);
    const half = Math.tan(poseOf(FRAME, 2 / 3).field / 2);
    expect(half).toBeCloseTo(2 * Math.tan(Math.PI / 6), 12);
  });

  it("lays the picture so that its edge is the photo's edge", () => {
    for (const [width, height] of [[1200, 600], [400, 600]] as const) {
      const [left, top, wide, tall] = boxOf(FRAME, width, height);
      expect(wide / tall).toBeCloseTo(FRAME.aspect, 12);
      expect([left * 2 + wide, top * 2 + tall]).toEqual([width, height]);
      const tan = Math.tan(poseOf(FRAME, width / height).field / 2);
      expect((tall / height) * tan).toBeCloseTo(Math.tan(Math.PI / 6), 12);
    }
  });
});

describe("leaving and flying", () => {
  it("orbits with the same eye and the same direction", () => {
    const pose = poseOf(FRAME, 2);
    const orbit = orbitAt(pose, 2);
    eyeOf(orbit).forEach((one, i) => expect(one).toBeCloseTo(pose.position[i]!, 12));
    axesOf(orbit).back.forEach((one, i) => expect(-one).toBeCloseTo(pose.forward[i]!, 12));
  });

  it("begins and ends where it should", () => {
    const from = { ...poseOf(FRAME, 2), position: [0, 0, 0] as [number, number, number] };
    expect(between(from, poseOf(FRAME, 2), 0).position).toEqual([0, 0, 0]);
    const end = between(from, poseOf(FRAME, 2), 1);
    expect(end.position).toEqual([1, 2, 1.5]);
    end.up.forEach((one, i) => expect(one).toBeCloseTo([0, 0, 1][i]!, 12));
  });
});

it("draws each camera as eight lines whose first ends are its eye", () => {
  const ends = pyramids([FRAME], 0.2);
  expect(ends.length).toBe(8 * 2 * 3);
  expect([...ends.slice(0, 3)]).toEqual([1, 2, 1.5]);
  const far = [...ends.slice(3, 6)];
  expect(far[0]).toBeCloseTo(1.2, 6);
});
