// Light or dark, as the system of the reader has it.

export type Theme = "light" | "dark";

/** Put the theme on the page, now and whenever it changes. */
export function followTheme(changed: (theme: Theme) => void): void {
  const light = matchMedia("(prefers-color-scheme: light)");
  const take = (): void => {
    const theme = light.matches ? "light" : "dark";
    document.documentElement.dataset.theme = theme;
    changed(theme);
  };
  light.addEventListener("change", take);
  take();
}
