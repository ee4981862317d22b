// Furniture that shares space with other furniture or leaves its room: asked of the server after
// each change, and said where the object is listed and inspected. Nothing is forbidden by it.

import { nameOf } from "../names";
import { TEXT } from "../text";
import type { State } from "../store";
import type { Clash } from "../wire";
import type { App } from "./slots";

const SOON_MS = 250; // Several changes of one gesture are asked about once.

export function watchClashes({ store, connection }: App): void {
  let known = "";
  let due = 0;
  const ask = async (key: string): Promise<void> => {
    const found = await connection.ask<Clash[]>("warnings").catch(() => null);
    if (found && key === known) store.set({ clashes: byObject(found) });
  };
  store.watch(["scene"], ({ scene }) => {
    const key = scene ? `${scene.document}.${scene.rev}` : "";
    if (key === known) return;
    known = key;
    clearTimeout(due);
    if (scene) due = window.setTimeout(() => void ask(key), SOON_MS);
  });
}

function byObject(found: readonly Clash[]): Map<number, Clash[]> {
  const clashes = new Map<number, Clash[]>();
  for (const one of found) for (const id of one.ids) clashes.set(id, [...(clashes.get(id) ?? []), one]);
  return clashes;
}

/** The objects that one collides with, by id, each once. */
export function collidingWith(id: number, clashes: State["clashes"]): number[] {
  const others = (clashes.get(id) ?? []).flatMap(({ kind, ids }) => (kind === "collision" ? ids : []));
  return [...new Set(others)].filter((other) => other !== id).sort((a, b) => a - b);
}

export function leavesRoom(id: number, clashes: State["clashes"]): boolean {
  return (clashes.get(id) ?? []).some(({ kind }) => kind === "outside");
}

/** All of it in one line, empty where there is nothing to say. */
export function clashWords(id: number, { clashes, objects }: Readonly<State>): string {
  const names = collidingWith(id, clashes).flatMap((other) => objects.get(other) ?? []).map(nameOf);
  const collides = names.length ? TEXT.clashes.with(names.join(", ")) : "";
  return [collides, leavesRoom(id, clashes) ? TEXT.clashes.outside : ""].filter(Boolean).join("; ");
}
