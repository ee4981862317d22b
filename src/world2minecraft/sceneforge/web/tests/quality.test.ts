import { describe, expect, it } from "vitest";

import { Quality, stepFor } from "../src/view/quality";

describe("fineness of moving frames", () => {
  it("goes down with slow frames until they are quick, and no further than there is", () => {
    const quality = new Quality();
    const first = quality.moving.scale;
    quality.took(60);
    expect(quality.moving.scale).toBeLessThan(first);
    for (let i = 0; i < 30; i++) quality.took(500);
    expect(quality.moving.scale).toBeGreaterThan(0.3);
    const lowest = quality.moving;
    for (let i = 0; i < 30; i++) quality.took(35);
    expect(quality.moving).toEqual(lowest);
  });

  it("comes up again only after many quick frames", () => {
    const quality = new Quality();
    quality.took(60);
    const low = quality.moving.scale;
    for (let i = 0; i < 5; i++) quality.took(17);
    expect(quality.moving.scale).toBe(low);
    for (let i = 0; i < 50; i++) quality.took(17);
    expect(quality.moving.scale).toBeGreaterThan(1);
  });

  it("never draws what stands still more coarsely than the screen", () => {
    const quality = new Quality();
    for (let i = 0; i < 30; i++) {
      expect(quality.still).toMatchObject({ coarse: 0 });
      expect(quality.still.scale).toBeGreaterThanOrEqual(1);
      quality.took(900);
    }
  });
});

describe("size of drawn blocks", () => {
  it("grows as cells get smaller than pixels, sooner where frames are to be quick", () => {
    expect([5, 1, 0.5, 0.1].map((pixels) => stepFor(pixels, 0))).toEqual([1, 2, 4, 4]);
    expect([0, 1, 2, 3].map((coarse) => stepFor(3, coarse))).toEqual([1, 1, 2, 4]);
    expect([0, 1, 2, 3].map((coarse) => stepFor(12, coarse))).toEqual([1, 1, 1, 1]);
  });
});
