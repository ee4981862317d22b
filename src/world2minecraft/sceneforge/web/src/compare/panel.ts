// Compare with a truth, a prediction, or the scene as it was opened; the figures follow each edit.

import { getJson, forget, said, sendBytes, sendJson } from "../start/api";
import type { ColourBy } from "../store";
import { TEXT } from "../text";
import { fill, h, setWhy } from "../ui/dom";
import { plainButton } from "../ui/fields";
import { registerPanel, type App } from "../ui/slots";
import type { Run } from "../wire";
import { readVolumeAt } from "../volume";
import { compare, type Compared } from "./count";

interface Told {
  name: string;
  has_truth: boolean;
  beyond: number[]; // cells outside the scene, by class
}

const SOON_MS = 40; // Several changes of one gesture are counted once.
const KINDS = ["added", "removed", "changed"] as const;

export function registerCompare(): void {
  registerPanel({
    id: "compare",
    title: TEXT.compare.title,
    place: "right",
    modes: ["inspect", "voxels", "objects"],
    order: 80,
    closed: true,
    mount: (host, app) => new ComparePanel(host, app),
  });
}

class ComparePanel {
  private other: Uint8Array | null = null;
  private beyond: readonly number[] = [];
  private name = "";
  private due = 0;
  private before: ColourBy = "class";
  private readonly figures = h("div", { class: "compare-figures", "aria-live": "polite" });
  private readonly truth: HTMLButtonElement;
  private readonly end: HTMLButtonElement;
  private readonly file = h("input", { type: "file", accept: ".npz,.npy,.json", hidden: true, data: { pick: "compare" } });

  constructor(
    host: HTMLElement,
    private readonly app: App,
  ) {
    const words = TEXT.compare;
    this.truth = plainButton(words.truth, () => void this.take(() => sendJson<Told>("api/compare/truth")));
    this.end = plainButton(words.end, () => void this.stop());
    const choose = plainButton(words.file, () => this.file.click());
    const opened = plainButton(words.opened, () => void this.take(() => sendJson<Told>("api/compare/opened")));
    this.file.addEventListener("change", () => {
      const [chosen] = this.file.files ?? [];
      const name = encodeURIComponent(chosen?.name ?? "");
      if (chosen) void this.take(() => sendBytes<Told>(`api/upload/compare?name=${name}`, chosen, { method: "POST" }));
      this.file.value = "";
    });
    host.append(
      h("p", { class: "note" }, words.lead),
      h("div", { class: "compare-choices" }, this.truth, opened, choose, this.end, this.file),
      this.figures,
    );
    this.show(null);
    app.store.watch(["scene"], ({ scene }) => scene && this.name === "" && void this.ask());
    app.store.watch(["labels", "scene", "view"], ({ view }, changed) => {
      if (!changed.has("view") || changed.size > 1 || view.hidden !== this.hidden) this.soon();
      this.hidden = view.hidden;
    });
  }

  private hidden: ReadonlySet<number> = new Set();
  private asked = "";

  /** Ask once a scene whether there is a truth. */
  private async ask(): Promise<void> {
    const { scene } = this.app.store.get();
    if (!scene || this.asked === scene.name) return;
    this.asked = scene.name;
    const told = await getJson<Told>("api/compare").catch(() => null);
    setWhy(this.truth, told?.has_truth ? "" : TEXT.compare.why.truth, TEXT.compare.truth);
  }

  private async take(choose: () => Promise<Told>): Promise<void> {
    try {
      const { name, beyond } = await choose();
      this.other = await readVolumeAt("api/compare/labels");
      [this.name, this.beyond] = [name, beyond];
      const { scene, view } = this.app.store.get();
      if (view.colourBy !== "difference") this.before = view.colourBy;
      if (scene) this.app.store.set({ scene: { ...scene, has: { ...scene.has, truth: true } } });
      this.count();
      this.app.store.setView({ colourBy: "difference" });
    } catch (error) {
      this.app.toast(said(error), "error");
    }
  }

  private async stop(): Promise<void> {
    this.other = null;
    this.name = "";
    this.app.view.setDifference(null);
    this.app.store.setView({ colourBy: this.before });
    const { scene } = this.app.store.get();
    if (scene) this.app.store.set({ scene: { ...scene, has: { ...scene.has, truth: false } } });
    this.show(null);
    await forget("api/compare").catch(() => undefined);
  }

  private soon(): void {
    if (!this.other) return;
    clearTimeout(this.due);
    this.due = window.setTimeout(() => this.count(), SOON_MS);
  }

  private count(): void {
    const { labels } = this.app.store.get();
    if (!this.other || this.other.length !== labels.length) return;
    const found = compare(labels, this.other, this.beyond);
    const { hidden } = this.app.store.get().view;
    this.app.view.setDifference({ ...found, removed: shownRuns(found.removed, this.other, hidden) });
    this.show(found);
  }

  private show(found: Compared | null): void {
    const words = TEXT.compare;
    this.end.hidden = !found;
    if (!found) {
      fill(this.figures);
      return;
    }
    const rows = KINDS.map((kind) =>
      h("div", { class: `compare-row is-${kind}` }, h("span", { class: "compare-mark" }), h("span", {}, words[kind]), h("output", { data: { compared: kind } }, words.cells(found.cells[kind]))),
    );
    fill(
      this.figures,
      h("p", { class: "compare-with" }, words.with(words.names[this.name] ?? this.name)),
      h("div", { class: "compare-scores" }, score(words.iou, found.iou, "iou"), score(words.miou, found.miou, "miou")),
      ...rows,
    );
  }
}

/** Runs without the cells whose class is hidden: a missing ceiling would lie over everything. */
function shownRuns(runs: readonly Run[], labels: Uint8Array, hidden: ReadonlySet<number>): Run[] {
  const shown: Run[] = [];
  for (const [first, length] of runs) {
    for (let flat = first; flat < first + length; flat++) {
      if (hidden.has(labels[flat]!)) continue;
      const last = shown.at(-1);
      if (last && last[0] + last[1] === flat) last[1] += 1;
      else shown.push([flat, 1]);
    }
  }
  return shown;
}

function score(name: string, value: number, id: string): HTMLElement {
  return h("div", { class: "compare-score" }, h("output", { data: { compared: id } }, TEXT.compare.percent(value)), h("span", { class: "note" }, name));
}
