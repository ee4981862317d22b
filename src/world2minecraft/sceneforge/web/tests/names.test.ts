// Objects are shown and found by their names, synonyms and classes.

import { expect, test } from "vitest";
import { THING_NAMES } from "../src/commands";
import { isFound, nameOf, offeredNames } from "../src/names";
import type { SceneObject } from "../src/wire";

function thing(id: number, class_id: number, name: string, title: string): SceneObject {
  const box = { center_m: [0, 0, 0], size_m: [1, 1, 1], yaw_deg: 0 } as const;
  return { id, class_id, name, name_confidence: 0.8, title, ...box, confidence: 1, cells: 1, placements: [] } as unknown as SceneObject;
}

const toilet = thing(3, 11, "toilet", "toilet");
const own = thing(14, 5, "Grandma's chair", "Grandma's chair");
const unnamed = thing(7, 10, "furniture", "furniture");

test("an object is shown with its name and id", () => {
  expect([toilet, own, unnamed].map(nameOf)).toEqual(["toilet 3", "Grandma's chair 14", "furniture 7"]);
});

test.each([
  ["toilet", [3]],
  ["WC", [3]],
  ["grandma", [14]],
  ["chair 14", [14]],
  ["furniture", [7]],
  ["object", [3]],
  ["piano", []],
])("searching %s finds %j", (typed, ids) => {
  expect([toilet, own, unnamed].filter((one) => isFound(one, typed)).map(({ id }) => id)).toEqual(ids);
});

test("names of the class are offered first, and structure never", () => {
  const offered = offeredNames(5);
  expect(offered[0]).toBe("chair");
  expect(offered).toContain("toilet");
  expect(offered).not.toContain("ceiling");
  expect(new Set(THING_NAMES.map(({ name }) => name)).size).toBe(THING_NAMES.length);
});
