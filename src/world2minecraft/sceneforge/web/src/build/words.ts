// A block state in words.

import { TEXT } from "../text";

export interface Described {
  name: string;
  id: string;
  facts: [string, string][];
}

/** "minecraft:oak_stairs[facing=east,half=bottom]" as a name and its properties. */
export function describe(state: string): Described {
  if (!state) return { name: TEXT.build.display, id: "minecraft:block_display", facts: [] };
  const [id = "", rest = ""] = state.split("[");
  const words = (id.split(":")[1] ?? id).replaceAll("_", " ");
  const facts = rest
    .replace("]", "")
    .split(",")
    .filter((pair) => pair && pair !== "waterlogged=false")
    .map((pair) => pair.split("=") as [string, string]);
  return { name: words.charAt(0).toUpperCase() + words.slice(1), id, facts };
}
