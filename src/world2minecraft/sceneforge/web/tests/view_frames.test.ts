import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { Frames, type Painted } from "../src/view/frames";
import { Quality } from "../src/view/quality";

interface Frame {
  full: boolean;
  pass: number | null;
}

let drawn: Frame[] = [];
let answer: Painted = { again: false, settled: true, more: false, usual: true };

function frames(): Frames {
  const quality = new Quality();
  return new Frames(quality, (_, __, pass) => {
    drawn.push({ full: pass !== null, pass });
    return answer;
  });
}

beforeEach(() => {
  drawn = [];
  answer = { again: false, settled: true, more: false, usual: true };
  vi.useFakeTimers({ toFake: ["setTimeout", "clearTimeout", "performance"] });
  vi.stubGlobal("window", globalThis);
  vi.stubGlobal("requestAnimationFrame", (call: (now: number) => void) => setTimeout(() => call(performance.now()), 16));
  vi.stubGlobal("cancelAnimationFrame", (id: number) => clearTimeout(id));
});

afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

describe("frames", () => {
  it("are drawn once for many changes, and once in full after a rest", async () => {
    const one = frames();
    for (let i = 0; i < 5; i++) one.invalidate();
    await vi.advanceTimersByTimeAsync(100);
    expect(drawn).toEqual([{ full: false, pass: null }]);
    await vi.advanceTimersByTimeAsync(1000);
    expect(drawn).toEqual([{ full: false, pass: null }, { full: true, pass: 0 }]);
  });

  it("are never drawn without a change", async () => {
    frames();
    await vi.advanceTimersByTimeAsync(5000);
    expect(drawn).toEqual([]);
  });

  it("go on while something moves by itself", async () => {
    const one = frames();
    answer = { ...answer, again: true };
    one.invalidate();
    await vi.advanceTimersByTimeAsync(200);
    expect(drawn.length).toBeGreaterThan(5);
    expect(drawn.some(({ full }) => full)).toBe(false);
  });

  it("are idle once all is there and drawn in full", async () => {
    const one = frames();
    answer = { ...answer, settled: false };
    let idle = false;
    void one.idle().then(() => (idle = true));
    await vi.advanceTimersByTimeAsync(1000);
    expect(idle).toBe(false);
    answer = { ...answer, settled: true };
    one.invalidate();
    await vi.advanceTimersByTimeAsync(100);
    expect(idle).toBe(true);
    expect(drawn.at(-1)!.full).toBe(true);
  });

  it("are averaged at rest until there are no more passes, or something changes", async () => {
    const one = frames();
    answer = { ...answer, more: true };
    one.invalidate();
    await vi.advanceTimersByTimeAsync(250);
    const passes = () => drawn.flatMap(({ pass }) => (pass === null ? [] : [pass]));
    expect(passes().slice(0, 3)).toEqual([0, 1, 2]);
    one.invalidate();
    const before = passes().length;
    await vi.advanceTimersByTimeAsync(100);
    expect(passes().length).toBe(before);
    answer = { ...answer, more: false };
    await vi.advanceTimersByTimeAsync(1000);
    expect(passes().slice(before)).toEqual([0]);
  });
});
