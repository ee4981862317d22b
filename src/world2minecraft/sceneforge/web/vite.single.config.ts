import { defineConfig } from "vite";

// Pages of their own, by the mode: `share`, the script and style of shared rooms, which Python puts
// into the page (rendering/mesh/viewer_page.py), and `phone` (sceneforge/server/phone_routes.py). One
// file of each kind; nothing is loaded, so there are no modules.
export default defineConfig(({ mode }) => ({
  publicDir: false,
  build: {
    outDir: "../static",
    emptyOutDir: false,
    target: "es2022",
    modulePreload: false,
    cssCodeSplit: false,
    rollupOptions: {
      input: `src/${mode}/main.ts`,
      output: { format: "iife", entryFileNames: `${mode}.js`, assetFileNames: `${mode}[extname]` },
    },
  },
}));
