// A shared room: what hangs together on the page, and what a person does on it.

import type { Light } from "../build/material";
import { followTheme } from "../theme";
import { h, takesText } from "../ui/dom";
import { segment } from "../ui/fields";
import { icon } from "../ui/icons";
import { turned, zoomed } from "../view/camera";
import { GoBox, nearNames } from "../walk/go_box";
import { Thumbs } from "../walk/thumbs";
import type { Vec3 } from "../wire";
import { readFloor, type RoomData, type Thing } from "./data";
import { coloursOf } from "./colours";
import { findThing, subjectOf } from "./finder";
import { Photos } from "./photos";
import { RoomView } from "./room_view";
import { Stroll } from "./stroll";
import { capital, TEXT } from "./text";
import { thingLabel, thingList } from "./things";

const CLICK_PX = 6;
const AHEAD_MS = 200; // between two looks at what is ahead
const TURN = 0.12; // radians, by a key
const GROUND = { light: 0xe9ebee, dark: 0x1b1e24 };

type Way = "look" | "walk";

export class RoomPage {
  readonly view: RoomView;
  stroll: Stroll | null = null; // once the floor has been read
  chosen: Thing | null = null;
  mode: Way = "look";
  light: Light = "day";
  private readonly canvas = h("canvas", { class: "canvas", tabindex: 0, role: "img", "aria-label": TEXT.canvas });
  private readonly stage = h("main", { class: "stage" });
  private readonly label = thingLabel({ go: (thing) => this.walkTo(thing, 1), close: () => this.choose(null) });
  private readonly list: ReturnType<typeof thingList>;
  private readonly go: GoBox;
  private readonly photos: Photos | null;
  private readonly ways = segment<Way>(TEXT.viewsLabel, () => (["look", "walk"] as const).map((value) => ({ value, label: TEXT.views[value] })), (way) => this.set(way));
  private readonly ahead = h("div", { class: "walk-ahead glass" });
  private aheadAt = 0;
  private readonly lamp: HTMLButtonElement;
  private pictures: HTMLButtonElement | null = null;
  private readonly more: HTMLButtonElement;
  private readonly thumbs = new Thumbs(TEXT.thumbs, { moved: () => undefined, tapped: (x, y) => this.tap(x, y) });

  constructor(
    private readonly host: HTMLElement,
    readonly room: RoomData,
  ) {
    const { facts, mesh } = room;
    host.append(this.stage);
    this.stage.append(this.canvas);
    this.list = thingList(facts.things, coloursOf(mesh), (thing) => this.visit(thing));
    this.go = new GoBox(TEXT.ask, (text) => this.ask(text));
    this.go.offer(facts.things.map(({ name }) => name));
    this.lamp = h("button", { class: "button", type: "button", "aria-pressed": "false", on: { click: () => this.setLight(this.light === "day" ? "night" : "day") } }, icon("moon"), TEXT.night);
    this.more = h("button", { class: "button more", type: "button", "aria-expanded": "false", on: { click: () => this.unfold() } }, TEXT.thingsCount(facts.things.length), icon("down"));
    host.append(this.head(), this.side());
    this.view = new RoomView(this.canvas, mesh, facts.azimuth);
    this.photos = facts.photos.length ? new Photos(this.view, facts.photos, () => this.show()) : null;
    if (this.photos) this.stage.append(this.photos.over);
    this.stage.append(this.thumbs.node, this.over(), this.label.node, this.bar());
    if (this.photos) this.stage.append(this.photos.bar);
    this.view.onFrame.push((now) => this.putWords(now));
    this.listen();
    followTheme((theme) => {
      this.view.ground = GROUND[theme];
      this.view.invalidate();
    });
    this.setLight("day");
    this.show();
  }

  /** Read the floor when the room is in the picture: walking is possible from then on. */
  async readFloor(): Promise<void> {
    if (!this.room.facts.can_walk) return;
    const calls = { leave: () => this.set("look"), arrived: (thing: Thing) => this.arrive(thing), broken: () => this.go.say("") };
    this.stroll = new Stroll(this.view, this.room, await readFloor(), this.thumbs, calls);
    this.stroll.dim(this.light === "night");
  }

  /** Go to what a sentence names. */
  ask(text: string): void {
    if (!text) return this.go.say(TEXT.ask.nothing);
    const { phrases, things } = this.room.facts;
    const found = findThing(text, phrases, things, (thing) => this.stroll?.away(thing) ?? 0);
    if ("thing" in found) return this.walkTo(found.thing, found.of);
    this.go.say(TEXT.unknown(subjectOf(text)), nearNames(found.near, (name) => this.ask(name)));
  }

  set(mode: Way): void {
    if (!this.stroll && mode === "walk") {
      this.go.say(this.room.facts.can_walk ? TEXT.soon : TEXT.noWalk);
      mode = "look";
    }
    this.photos?.close();
    if (mode !== this.mode) {
      if (!this.stroll?.isLed) this.go.say("");
      if (mode === "walk") {
        this.choose(null);
        this.stroll?.enter();
      } else this.stroll?.leave();
      this.mode = mode;
    }
    this.show();
  }

  setLight(light: Light): void {
    this.light = light;
    this.view.setLight(light);
    this.stroll?.dim(light === "night");
    this.lamp.setAttribute("aria-pressed", String(light === "night"));
    this.show();
  }

  choose(thing: Thing | null, canGo = this.room.facts.can_walk): void {
    this.chosen = thing;
    this.list.mark(thing);
    this.label.show(thing, canGo);
    const box = thing && this.room.mesh.boxOf(thing.id);
    this.view.blocks.outline("object", box ? [box] : []);
    this.view.invalidate();
  }

  idle(): Promise<void> {
    return this.view.idle();
  }

  /** From the list: fly to a thing, or walk to it where one walks. */
  private visit(thing: Thing): void {
    this.fold();
    if (this.mode === "walk") return this.walkTo(thing, 1);
    this.photos?.close();
    this.choose(thing);
    this.view.focus({ low: thing.low_m, high: thing.high_m });
  }

  private walkTo(thing: Thing, of: number): void {
    if (!this.stroll) return this.go.say(this.room.facts.can_walk ? TEXT.soon : TEXT.noWalk);
    this.fold();
    this.photos?.close();
    const away = this.stroll.lead(thing);
    if (away === null) return this.go.say(TEXT.noWay(thing.name));
    this.choose(null);
    if (this.mode === "look") this.view.frame();
    this.go.say(TEXT.walking(thing.name, away, of));
  }

  private arrive(thing: Thing): void {
    this.go.say(TEXT.arrived(thing.name));
    this.choose(thing, false);
  }

  private tap(clientX: number, clientY: number): void {
    const box = this.canvas.getBoundingClientRect();
    this.choose(this.thingAt(clientX - box.left, clientY - box.top));
  }

  thingAt(x: number, y: number): Thing | null {
    const met = this.view.meetAt(x, y);
    const id = met ? this.room.mesh.instance[met.quad] : 0;
    return this.room.facts.things.find((thing) => thing.id === id) ?? null;
  }

  private head(): HTMLElement {
    const { facts } = this.room;
    return h("header", { class: "head" }, h("h1", {}, facts.title), h("p", { class: "head-facts" }, TEXT.facts(facts.size_m, facts.things.length)));
  }

  private side(): HTMLElement {
    return h("aside", { class: "side" }, this.room.facts.can_walk && this.go.node, h("h2", {}, TEXT.things), this.more, h("div", { class: "things-frame" }, this.list.node), h("p", { class: "made" }, TEXT.made));
  }

  private over(): HTMLElement {
    return h("div", { class: "walk-over" }, h("div", { class: "walk-cross" }), h("div", { class: "walk-hint glass" }, TEXT.walkHint), this.ahead);
  }

  private bar(): HTMLElement {
    const whole = h("button", { class: "button is-whole", type: "button", on: { click: () => { this.choose(null); this.view.frame(); } } }, icon("home"), TEXT.whole); // prettier-ignore
    if (this.photos) this.pictures = h("button", { class: "button is-photos", type: "button", on: { click: () => this.openPhotos() } }, icon("photo"), TEXT.photos);
    return h("nav", { class: "bar glass", "aria-label": TEXT.viewsLabel }, this.room.facts.can_walk && this.ways.node, this.lamp, this.pictures, whole);
  }

  private openPhotos(): void {
    this.set("look");
    this.go.say("");
    this.choose(null);
    this.setLight("day"); // As photos are.
    this.stroll?.hide();
    this.photos?.open();
    this.pictures?.setAttribute("aria-pressed", "true");
    this.host.dataset.photos = "on";
  }

  private show(): void {
    this.ways.set(this.mode);
    this.host.dataset.mode = this.mode;
    this.host.dataset.light = this.light;
    this.pictures?.setAttribute("aria-pressed", "false");
    this.host.dataset.photos = "off";
    this.canvas.setAttribute("aria-label", this.mode === "walk" ? TEXT.walkHint : TEXT.canvas);
    this.view.invalidate();
  }

  private unfold(): void {
    const open = this.host.dataset.list !== "open";
    this.host.dataset.list = open ? "open" : "closed";
    this.more.setAttribute("aria-expanded", String(open));
  }

  private fold(): void {
    if (this.host.dataset.list === "open") this.unfold();
  }

  private putWords(now: number): void {
    if (this.mode === "walk" && now - this.aheadAt > AHEAD_MS) {
      this.aheadAt = now;
      const thing = this.thingAt(this.canvas.clientWidth / 2, this.canvas.clientHeight / 2);
      this.ahead.textContent = thing ? capital(thing.name) : "";
    }
    if (!this.chosen) return;
    const { low_m: low, high_m: high } = this.chosen;
    const top: Vec3 = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, high[2]];
    const at = this.view.project(top);
    this.label.put(at && [at[0], at[1] - 10], this.canvas.clientWidth);
  }

  private listen(): void {
    let down: [number, number] | null = null;
    this.canvas.addEventListener("pointerdown", (event) => {
      down = event.isPrimary && event.button === 0 ? [event.clientX, event.clientY] : null;
    });
    this.canvas.addEventListener("pointerup", (event) => {
      const still = down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < CLICK_PX;
      if (still && this.mode === "look") this.tap(event.clientX, event.clientY);
      down = null;
    });
    document.addEventListener("keydown", (event) => this.key(event));
  }

  private key(event: KeyboardEvent): void {
    if (event.key === "Escape" && this.mode === "look") {
      this.photos?.close();
      this.choose(null);
      this.fold();
    }
    const plain = !event.ctrlKey && !event.metaKey && !event.altKey;
    if (this.mode !== "look" || !plain || takesText(event.target) || event.target instanceof HTMLButtonElement) return;
    const { orbit } = this.view;
    const moves: Record<string, () => typeof orbit> = {
      ArrowLeft: () => turned(orbit, -TURN, 0),
      ArrowRight: () => turned(orbit, TURN, 0),
      ArrowUp: () => turned(orbit, 0, TURN),
      ArrowDown: () => turned(orbit, 0, -TURN),
      "+": () => zoomed(orbit, 0.88, null),
      "-": () => zoomed(orbit, 1.14, null),
    };
    const move = moves[event.key];
    if (!move || this.view.pose) return;
    event.preventDefault();
    this.view.orbit = move();
  }
}
