// The rooms and captures that are there, and rooms that can be made of nothing.

import { TEXT } from "../text";
import { h } from "../ui/dom";
import { icon } from "../ui/icons";
import { plainButton } from "../ui/fields";
import type { CaptureTold, StartTold } from "./told";

export interface RoomActions {
  look(id: string): void;
  open(id: string): void;
  demo(kind: string): void;
}

export function roomsView(told: StartTold, actions: RoomActions): HTMLElement {
  const words = TEXT.start;
  const rows = [
    ...told.captures.map((one) => captureRow(one, actions)),
    ...told.recent.map(({ id, name, folder, has_picture }) =>
      row(name, folder, words.states.here, has_picture ? pictureOf(id) : null, () => actions.open(id)),
    ),
  ];
  const kinds = told.demos.map((kind) => plainButton(words.kinds[kind] ?? kind, () => actions.demo(kind)));
  for (const [at, kind] of told.demos.entries()) kinds[at]!.dataset.demo = kind;
  return h(
    "div",
    { class: "stack" },
    rows.length > 0 && h("h2", {}, words.rooms),
    rows.length > 0 && h("ul", { class: "room-list" }, ...rows),
    exampleCard(actions),
    h("h2", {}, words.demo),
    h("p", { class: "note" }, words.demoLead),
    h("div", { class: "demo-kinds" }, ...kinds),
  );
}

/** A finished room, which opens at once. */
function exampleCard(actions: RoomActions): HTMLElement {
  const words = TEXT.start;
  const card = h(
    "button",
    { type: "button", class: "example-card", data: { do: "example" } },
    h("img", { src: pictureOf("example"), alt: "", width: 720, height: 540 }),
    h("span", { class: "example-words" }, h("strong", {}, words.example), h("span", { class: "note" }, words.exampleLead)),
  );
  card.addEventListener("click", () => actions.open("example"));
  return card;
}

function pictureOf(id: string): string {
  return `api/start/rooms/${id}/picture`;
}

function captureRow(one: CaptureTold, actions: RoomActions): HTMLElement {
  const { states } = TEXT.start;
  const state = one.job ? states.working : one.has_room ? states.room : one.complete ? states.ready : states.partly;
  const about = one.elsewhere || TEXT.start.megabytes(one.bytes / 2 ** 20);
  const picture = one.has_room ? pictureOf(one.id) : null;
  return row(one.title, about, state, picture, () => actions.look(one.id));
}

function row(name: string, about: string, state: string, picture: string | null, run: () => void): HTMLElement {
  const shown = picture ? h("img", { src: picture, alt: "", loading: "lazy" }) : icon("cube");
  const node = h(
    "button",
    { type: "button", class: "room-row" },
    h("span", { class: "room-picture" }, shown),
    h("span", { class: "room-words" }, h("strong", {}, name), h("span", { class: "note" }, about)),
    h("span", { class: "room-state" }, state),
  );
  node.addEventListener("click", run);
  return h("li", {}, node);
}
