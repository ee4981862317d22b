// Dark or light: what the person chose last, else what the system says.

import type { Store } from "../store";

const MEMORY = "sceneforge.theme";

export function applyTheme(store: Store): void {
  const light = matchMedia("(prefers-color-scheme: light)").matches;
  const chosen = localStorage.getItem(MEMORY);
  store.set({ theme: chosen === "light" || chosen === "dark" ? chosen : light ? "light" : "dark" });
  store.watch(["theme"], ({ theme }) => {
    document.documentElement.dataset.theme = theme;
  });
}

export function switchTheme(store: Store): void {
  const theme = store.get().theme === "dark" ? "light" : "dark";
  localStorage.setItem(MEMORY, theme);
  store.set({ theme });
}
