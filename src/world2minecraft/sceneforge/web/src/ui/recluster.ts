// Finds objects anew from the cells: three sliders, and the centres that they would give.

import type { Vec3 } from "../wire";
import { TEXT } from "../text";
import { cannotEdit } from "./blocked";
import { h, setWhy } from "./dom";
import { plainButton, slider } from "./fields";
import type { App } from "./slots";

interface Centre {
  class_id: number;
  at_m: Vec3;
  cells?: number;
}

// Those of the reconstruction; the sliders go around them.
const params = { density_kernel: 3, density_threshold: 0.2, cluster_radius: 2 };
type Name = keyof typeof params;

const RANGES: Record<Name, [number, number, number]> = {
  density_kernel: [1, 9, 2],
  density_threshold: [0, 1, 0.02],
  cluster_radius: [1, 10, 0.5],
};
const PAUSE_MS = 150; // after the last change of a slider, before the server is asked

export function recluster(app: App, classId: number | null): void {
  void app.do({ op: "recluster", ...(classId === null ? {} : { class_id: classId }), ...params });
}

export function mountRecluster(host: HTMLElement, app: App): void {
  const note = h("p", { class: "note", "aria-live": "polite" }, TEXT.recluster.note);
  const marks = h("div", { class: "centre-preview", "aria-hidden": "true" });
  app.stage.append(marks);
  let shown: Centre[] = [];
  let timer = 0;
  let asked = 0;
  const place = (): void => placeDots(app, marks, shown);
  app.view.onFrame.push(place);
  const clear = (): void => {
    asked += 1;
    shown = [];
    marks.replaceChildren();
    note.textContent = TEXT.recluster.note;
  };
  const ask = async (): Promise<void> => {
    const mine = ++asked;
    const found = await app.ask<Centre[]>("centers", { ...params });
    if (!found || mine !== asked) return; // A later one is on its way, or the preview was closed.
    shown = found;
    note.textContent = TEXT.recluster.found(shown.length, app.store.get().objects.size);
    makeDots(app, marks, shown);
    place();
  };
  const sliders = (Object.keys(params) as Name[]).map((name) => {
    const [min, max, step] = RANGES[name];
    const one = slider({
      label: TEXT.recluster[name],
      id: name,
      min,
      max,
      step,
      show: name === "density_threshold" ? String : TEXT.cells,
      change: (value) => {
        params[name] = value;
        clearTimeout(timer);
        timer = window.setTimeout(() => void ask(), PAUSE_MS);
      },
    });
    one.set(params[name]);
    return one.node;
  });
  const run = plainButton(TEXT.recluster.run, () => {
    recluster(app, null);
    clear();
  }, "button is-wide");
  const hide = plainButton(TEXT.recluster.hide, clear);
  host.append(h("div", { class: "stack" }, ...sliders, note, h("div", { class: "row is-even" }, run, hide)));
  app.store.watch(["scene", "online"], () => setWhy(run, cannotEdit(app.store), TEXT.recluster.run));
  app.store.watch(["mode"], ({ mode }) => mode !== "objects" && clear());
}

function makeDots({ store }: App, marks: HTMLElement, centres: readonly Centre[]): void {
  const classes = store.get().scene?.classes ?? [];
  marks.replaceChildren(
    ...centres.map(({ class_id }) =>
      h("i", { vars: { "--swatch": `rgb(${(classes[class_id]?.colour ?? [255, 255, 255]).join(" ")})` } }),
    ),
  );
}

function placeDots({ view }: App, marks: HTMLElement, centres: readonly Centre[]): void {
  centres.forEach(({ at_m }, at) => {
    const dot = marks.children[at] as HTMLElement | undefined;
    const where = view.project(at_m);
    if (!dot) return;
    dot.hidden = !where;
    if (where) dot.style.transform = `translate(${where[0]}px, ${where[1]}px)`;
  });
}
