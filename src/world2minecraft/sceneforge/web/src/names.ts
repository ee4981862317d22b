// Names of objects: what people read, and what they may type to find one.

import { THING_NAMES } from "./commands";
import { TEXT } from "./text";
import type { SceneObject } from "./wire";

const WORDS = new Map(THING_NAMES.map(({ name, title, labels }) => [name, [name, title, ...labels]]));

/** The name with the id, such as "toilet 3". */
export function nameOf(one: SceneObject): string {
  return TEXT.objects.name(one.title, one.id);
}

/** Whether each typed word is in the name, one of its synonyms, the class or the id. */
export function isFound(one: SceneObject, typed: string): boolean {
  const words = [...(WORDS.get(one.name) ?? []), one.title, TEXT.classes[one.class_id] ?? "", String(one.id)];
  const text = words.join("\n").toLowerCase();
  return typed
    .toLowerCase()
    .split(/\s+/)
    .every((part) => text.includes(part));
}

/** All names to choose from, those of a class first. */
export function offeredNames(classId: number): string[] {
  const own = THING_NAMES.filter(({ class_id }) => class_id === classId);
  const others = THING_NAMES.filter(({ class_id }) => class_id !== classId && class_id >= 5);
  return [...own, ...others].map(({ title }) => title);
}
