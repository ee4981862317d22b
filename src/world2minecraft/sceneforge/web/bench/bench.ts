// The scene view alone on a page, as benchmarks/check_forge_view.py measures it.

import { Store } from "../src/store";
import { SceneView } from "../src/view/view";
import { parseVolume } from "../src/volume";
import type { Scene } from "../src/wire";

import { drawEach } from "./each";

async function main(): Promise<void> {
  const canvas = document.querySelector("canvas")!;
  const store = new Store();
  const [scene, block] = await Promise.all([
    fetch("api/scene").then((answer) => answer.json() as Promise<Scene>),
    fetch("api/volume?what=labels").then(async (answer) => parseVolume(await answer.arrayBuffer())),
  ]);
  const each = new URLSearchParams(location.search).get("each");
  if (each) {
    drawEach(canvas, scene, block.cells as Uint8Array, each);
    return;
  }
  const view = new SceneView(canvas, store);
  store.set({ scene, labels: block.cells as Uint8Array });
  Object.assign(window, { __forge: { store, view, idle: () => view.idle() } });
}

void main();
