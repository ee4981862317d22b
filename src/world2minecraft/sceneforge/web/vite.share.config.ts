import { defineConfig } from "vite";

// The script and the style of shared rooms: one file of each, which Python puts into the page
// (sceneforge/share/page.py). Nothing is loaded, so there are no modules.
export default defineConfig({
  publicDir: false,
  build: {
    outDir: "../static",
    emptyOutDir: false,
    target: "es2022",
    modulePreload: false,
    cssCodeSplit: false,
    rollupOptions: {
      input: "src/share/main.ts",
      output: { format: "iife", entryFileNames: "share.js", assetFileNames: "share[extname]" },
    },
  },
});
