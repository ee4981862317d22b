// Doubtful places, worst first: one key goes from each to the next.

import type { Vec3 } from "../wire";
import { TEXT } from "../text";
import { boxOf } from "../tools/objects_at";
import { fill, h } from "./dom";
import { plainButton } from "./fields";
import { unfold } from "./panels";
import { rove } from "./rove";
import type { App } from "./slots";

interface Doubt {
  at_m: Vec3;
  why: string; // a sentence
  object_id?: number | null;
}

const AROUND_M = 0.6; // half of what is seen around a place without an object

export function mountDoubtful(host: HTMLElement, app: App): void {
  let places: Doubt[] = [];
  let at = -1;
  let known = -1; // the revision that they are of
  const note = h("p", { class: "note", "aria-live": "polite" }, TEXT.doubtful.note);
  const list = h("div", { class: "found-list", role: "group", "aria-label": TEXT.doubtful.title });
  const draw = (): void => {
    fill(list, ...places.slice(0, 40).map((one, row) => rowOf(one, row, row === at, go)));
    if (known >= 0) note.textContent = places.length ? TEXT.doubtful.at(at + 1, places.length) : TEXT.doubtful.none;
  };
  const go = (to: number): void => {
    at = to;
    const place = places[to];
    draw();
    if (!place) return;
    visit(app, place);
    app.store.set({ status: sentence(place.why) });
  };
  const step = async (by: number): Promise<void> => {
    const rev = app.store.get().scene?.rev ?? 0;
    if (rev !== known) {
      const asked = await app.ask<Doubt[]>("doubtful");
      if (!asked) return;
      places = asked;
      known = rev;
      at = Math.min(at, places.length - 1);
    }
    if (!places.length) app.toast(TEXT.doubtful.none);
    go(places.length ? (at + by + places.length + (at < 0 && by < 0 ? 1 : 0)) % places.length : -1);
  };
  const why = (): string => (app.store.get().scene ? "" : TEXT.why.noScene);
  const asked = (by: number): void => {
    unfold("doubtful");
    void step(by);
  };
  app.actions.on("doubtful.next", { run: () => asked(1), why });
  app.actions.on("doubtful.previous", { run: () => asked(-1), why });
  const next = plainButton(TEXT.doubtful.next, () => void step(1));
  const previous = plainButton(TEXT.doubtful.previous, () => void step(-1));
  host.append(h("div", { class: "stack" }, h("div", { class: "row is-even" }, previous, next), note, list));
  rove(list);
}

function rowOf(one: Doubt, at: number, chosen: boolean, go: (at: number) => void): HTMLElement {
  const node = h("button", { type: "button", class: "found", data: { doubt: String(at) } });
  node.append(h("span", { class: "found-at" }, at + 1), h("span", { class: "found-why" }, sentence(one.why)));
  node.setAttribute("aria-pressed", String(chosen));
  node.addEventListener("click", () => go(at));
  return node;
}

function sentence(why: string): string {
  return why.charAt(0).toUpperCase() + why.slice(1);
}

function visit({ store, view }: App, place: Doubt): void {
  const one = place.object_id ? store.get().objects.get(place.object_id) : undefined;
  if (one) store.set({ selectedObjects: new Set([one.id]) });
  const around = {
    low: place.at_m.map((value) => value - AROUND_M) as Vec3,
    high: place.at_m.map((value) => value + AROUND_M) as Vec3,
  };
  view.focus(one ? boxOf(one) : around);
}
