// One stop of the Tab key for a row of buttons; the arrow keys go along it.

const ALONG: Record<string, number> = { ArrowRight: 1, ArrowLeft: -1 };
const ACROSS: Record<string, number> = { ArrowDown: 1, ArrowUp: -1 };

/** Let the arrow keys, Home and End move between the controls of a row, or of a grid of columns. */
export function rove(host: HTMLElement, select = "button", columns = 1): void {
  const items = (): HTMLElement[] =>
    [...host.querySelectorAll<HTMLElement>(select)].filter((one) => one.offsetParent !== null);
  const settle = (chosen?: HTMLElement): void => {
    const all = items();
    const held = chosen ?? all.find((one) => one.tabIndex === 0) ?? all[0];
    for (const one of all) one.tabIndex = one === held ? 0 : -1;
  };
  host.addEventListener("focusin", (event) => {
    const item = (event.target as HTMLElement).closest<HTMLElement>(select);
    if (item && host.contains(item)) settle(item);
  });
  host.addEventListener("keydown", (event) => {
    const all = items();
    const at = all.indexOf(document.activeElement as HTMLElement);
    const across = ACROSS[event.key];
    const step = ALONG[event.key] ?? (across && across * columns);
    if (at < 0 || (step === undefined && event.key !== "Home" && event.key !== "End")) return;
    const last = all.length - 1;
    const to = event.key === "Home" ? 0 : event.key === "End" ? last : at + (step ?? 0);
    all[(to + all.length) % all.length]?.focus();
    event.preventDefault();
    event.stopPropagation();
  });
  new MutationObserver(() => settle()).observe(host, { childList: true, subtree: true });
  requestAnimationFrame(() => settle());
}
