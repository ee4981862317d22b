import { Store } from "./store";

const store = new Store();
store.watch(["scene"], ({ scene }) => {
  document.title = scene ? `${scene.name} · SceneForge` : "SceneForge";
});
