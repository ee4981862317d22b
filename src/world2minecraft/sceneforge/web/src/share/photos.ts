// Standing where a photo was taken, with a slider between the photo and the room.

import { boxOf, orbitAt, poseOf, type Frame } from "../photos/place";
import { h } from "../ui/dom";
import { icon } from "../ui/icons";
import { photoAddress } from "./data";
import type { RoomView } from "./room_view";
import { TEXT } from "./text";

const LOOKED_AT_M = 2;

export class Photos {
  readonly over = h("div", { class: "photo", hidden: true });
  readonly bar: HTMLElement;
  private readonly picture = h("img", { class: "photo-picture", alt: "" });
  private readonly edge = h("div", { class: "photo-edge", "aria-hidden": "true" });
  private readonly count = h("span", { class: "photo-count" });
  private readonly slider = h("input", { type: "range", min: 0, max: 100, step: 1, value: "50", "aria-label": TEXT.slider });
  private shown = 0;
  private isOn = false;

  constructor(
    private readonly view: RoomView,
    private readonly frames: readonly Frame[],
    private readonly closed: () => void,
  ) {
    const button = (label: string, name: "back" | "close", call: () => void, more = ""): HTMLElement =>
      h("button", { class: `button icon-only ${more}`, type: "button", title: label, "aria-label": label, on: { click: call } }, icon(name));
    this.over.append(this.picture, this.edge);
    this.bar = h("div", { class: "photo-bar glass", hidden: true },
      button(TEXT.previous, "back", () => this.show(this.shown - 1)),
      this.count,
      button(TEXT.next, "back", () => this.show(this.shown + 1), "is-turned"),
      h("label", { class: "photo-slider" }, h("span", {}, TEXT.before), this.slider, h("span", {}, TEXT.after)),
      button(TEXT.closePhotos, "close", () => this.close()),
    ); // prettier-ignore
    this.slider.addEventListener("input", () => this.lay());
    new ResizeObserver(() => this.isOn && this.stand()).observe(view.canvas);
  }

  open(): void {
    this.isOn = true;
    this.over.hidden = this.bar.hidden = false;
    this.show(this.shown);
  }

  close(): void {
    if (!this.isOn) return;
    this.isOn = this.view.isInside = false;
    this.over.hidden = this.bar.hidden = true;
    const { pose } = this.view;
    this.view.pose = null;
    if (pose) this.view.orbit = orbitAt(pose, LOOKED_AT_M);
    this.view.frame();
    this.closed();
  }

  private show(n: number): void {
    this.shown = (n + this.frames.length) % this.frames.length;
    this.picture.src = photoAddress(this.shown);
    const numbers = [this.shown + 1, this.frames.length] as const;
    this.picture.alt = TEXT.photo(...numbers);
    this.count.textContent = TEXT.photoCount(...numbers);
    this.stand();
  }

  private stand(): void {
    this.view.isInside = true;
    this.view.pose = poseOf(this.frames[this.shown]!, this.view.aspect);
    this.lay();
  }

  /** The photo lies where the room is seen from the same place; the slider's left part is drawn. */
  private lay(): void {
    const { clientWidth, clientHeight } = this.view.canvas;
    const [left, top, wide, tall] = boxOf(this.frames[this.shown]!, clientWidth, clientHeight);
    for (const [name, value] of Object.entries({ left, top, width: wide, height: tall })) {
      this.over.style.setProperty(name, `${value}px`);
    }
    const share = 100 - Number(this.slider.value);
    this.picture.style.setProperty("clip-path", `inset(0 ${100 - share}% 0 0)`);
    this.edge.style.setProperty("left", `${share}%`);
    this.slider.setAttribute("aria-valuetext", `${share}% ${TEXT.before}`);
  }
}
