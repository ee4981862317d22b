import { expect, test } from "vitest";

import { BINDINGS, bindingFor, strokeName, type Stroke } from "../src/keys";
import type { Mode } from "../src/store";

const MODES: Mode[] = ["inspect", "voxels", "objects", "build", "walk"];

function stroke(key: string, code: string, held: Partial<Stroke> = {}): Stroke {
  return { key, code, ctrlKey: false, metaKey: false, shiftKey: false, altKey: false, ...held };
}

test("no key means two things in one mode", () => {
  for (const mode of MODES) {
    const here = BINDINGS.filter((one) => !one.gesture && (!one.modes || one.modes.includes(mode)));
    const keys = here.flatMap((one) => one.keys);
    expect(keys).toEqual([...new Set(keys)]);
  }
});

test("each line of the table has its own name and words", () => {
  const ids = BINDINGS.map((one) => one.id);
  expect(ids).toEqual([...new Set(ids)]);
  for (const one of BINDINGS) expect(one.title).not.toBe("");
});

test("a stroke has one name, whatever the board", () => {
  expect(strokeName(stroke("z", "KeyY", { ctrlKey: true }))).toBe("Ctrl+Z");
  expect(strokeName(stroke("z", "KeyZ", { metaKey: true, shiftKey: true }))).toBe("Ctrl+Shift+Z");
  expect(strokeName(stroke("?", "Slash", { shiftKey: true }))).toBe("?");
  expect(strokeName(stroke("!", "Digit1", { shiftKey: true }))).toBe("Shift+1");
  expect(strokeName(stroke("|", "Backslash", { shiftKey: true }))).toBe("Shift+\\");
  expect(strokeName(stroke("7", "Numpad7"))).toBe("Numpad7");
  expect(strokeName(stroke(" ", "Space", { shiftKey: true }))).toBe("Shift+Space");
});

test("a key means what its mode says", () => {
  expect(bindingFor(stroke("b", "KeyB"), "voxels")?.id).toBe("tool.brush");
  expect(bindingFor(stroke("b", "KeyB"), "objects")).toBeUndefined();
  expect(bindingFor(stroke("z", "KeyZ", { ctrlKey: true }), "walk")?.id).toBe("undo");
});
