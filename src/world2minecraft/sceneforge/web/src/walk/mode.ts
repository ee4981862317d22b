// Walk: through the build, or through the voxels, with the game's physics.

import { SKIES } from "../build/material";
import { builderOf } from "../build/mode";
import { describe } from "../build/words";
import { Packet } from "../build/packet";
import { Color } from "three";
import type { Mode } from "../store";
import { nameOf } from "../names";
import { TEXT } from "../text";
import { fill, h } from "../ui/dom";
import { segment } from "../ui/fields";
import { registerMode, registerPanel, registerStagePart, type App } from "../ui/slots";
import type { SceneView } from "../view/view";
import { mountAsk } from "./ask";
import { Input } from "./input";
import { Thumbs } from "./thumbs";
import { Walker } from "./walker";

type Ground = "blocks" | "voxels";

/** What walks in place of the person; `pass` says whether it is done. */
export interface Way {
  pass(walker: Walker, milliseconds: number): boolean;
}

/** A way, and what happens at its end. */
export interface Lead {
  way(walker: Walker): Way;
  arrived(): void;
  broken(): void; // the person walked on
}

const MOST_STEP_MS = 250; // of a way: who looked elsewhere does not leap
const TOLD_MS = 250; // between two looks at what is ahead

export class Walking {
  walker: Walker | null = null;
  ground: Ground = "blocks";
  readonly thumbs = new Thumbs(TEXT.walk.thumbs, { moved: () => undefined, tapped: () => undefined });
  private readonly input: Input;
  private readonly view: SceneView;
  private back: Mode = "inspect";
  private frame = 0;
  private last = 0;
  private toldAt = 0;
  private behind: SceneView["scene"]["background"] = null; // what was behind all before
  private readonly sky = new Color();
  private listeners = new Set<() => void>();
  private asked = 0;
  private led: { way: Way; lead: Lead } | null = null;

  constructor(private readonly app: App) {
    this.view = app.view as unknown as SceneView;
    this.input = new Input(app.canvas, { leave: () => this.app.store.set({ mode: this.back }), moved: () => this.take() }, this.thumbs);
    app.store.watch(["mode"], ({ mode }) => {
      if (mode !== "walk") this.back = mode;
    });
    builderOf(app).watch(() => void this.renew());
    app.store.watch(["touched"], () => this.ground === "voxels" && void this.renew());
  }

  watch(call: () => void): void {
    this.listeners.add(call);
  }

  get isOn(): boolean {
    return this.app.store.get().mode === "walk";
  }

  /** Blocks a metre of what is walked on, as far as it is a build. */
  get size(): number {
    return builderOf(this.app).loader.wish.size;
  }

  /** Be led along a way; null ends it. */
  lead(lead: Lead | null): void {
    const { walker } = this;
    this.led = walker && lead ? { way: lead.way(walker), lead } : null;
  }

  /** Keys and thumbs of a person count more than the planner and an agent. */
  private take(): void {
    const { led } = this;
    this.led = null;
    led?.lead.broken();
  }

  enter(): void {
    this.behind = this.view.scene.background;
    this.choose(this.ground);
    this.input.start();
    (document.activeElement as HTMLElement | null)?.blur();
    this.last = performance.now();
    this.frame = requestAnimationFrame((now) => this.pass(now));
  }

  leave(): void {
    cancelAnimationFrame(this.frame);
    this.input.stop();
    this.walker = this.led = null;
    this.view.pose = null;
    this.view.scene.background = this.behind;
    builderOf(this.app).show(false);
  }

  choose(ground: Ground): void {
    this.ground = ground;
    builderOf(this.app).show(ground === "blocks", true);
    void this.load();
    this.tell();
  }

  private async renew(): Promise<void> {
    const { mesh, busy } = builderOf(this.app).loader;
    const rev = this.ground === "blocks" ? mesh?.facts.rev : this.app.store.get().scene?.rev;
    const size = this.ground === "blocks" ? mesh?.facts.blocks_per_metre : this.walker?.scale;
    if (!this.isOn || busy || !this.walker) return;
    if (this.walker.rev !== rev || this.walker.scale !== size) await this.load();
  }

  private async load(): Promise<void> {
    const asked = ++this.asked;
    const { size, style } = builderOf(this.app).loader.wish;
    const build = `what=build&blocks_per_metre=${size}&style=${style}`;
    const answer = await fetch(`api/collision?${this.ground === "blocks" ? build : "what=voxels"}`);
    if (!answer.ok) {
      this.app.toast(((await answer.json()) as { error: string }).error, "error");
      return;
    }
    const data = await answer.arrayBuffer();
    if (asked !== this.asked || !this.isOn) return;
    const walker = new Walker(Packet.read(data, "W2MC"));
    if (this.walker) walker.standAt(this.walker);
    this.take(); // The way is one through other blocks.
    this.walker = walker;
    this.tell();
  }

  private pass(now: number): void {
    this.frame = requestAnimationFrame((next) => this.pass(next));
    const milliseconds = now - this.last;
    this.last = now;
    const { walker } = this;
    if (!walker) return;
    this.showSky();
    if (this.led) this.follow(this.led, walker, milliseconds);
    else this.steer(walker, milliseconds);
    if (now - this.toldAt > TOLD_MS) {
      this.toldAt = now;
      this.tell();
    }
  }

  private steer(walker: Walker, milliseconds: number): void {
    const [right, down] = this.input.look(milliseconds);
    walker.look(right, down);
    walker.keys = this.input.keys;
    const moved = walker.pass(milliseconds);
    if (!moved && !right && !down && this.view.pose) return;
    this.view.pose = walker.pose;
    this.app.connection.active();
  }

  private follow(led: { way: Way; lead: Lead }, walker: Walker, milliseconds: number): void {
    const isDone = led.way.pass(walker, Math.min(milliseconds, MOST_STEP_MS));
    this.view.pose = walker.pose;
    this.app.connection.active();
    if (!isDone) return;
    this.led = null;
    led.lead.arrived();
  }

  /** The view paints its own ground behind all when the theme or the legend changes. */
  private showSky(): void {
    const wanted = SKIES[builderOf(this.app).blocks.material.light];
    if (this.view.scene.background === this.sky && this.sky.getHex() === wanted) return;
    this.view.scene.background = this.sky.setHex(wanted);
    this.view.invalidate();
  }

  /** What is in the middle of the picture, in words. */
  ahead(): string {
    const { pose } = this.view;
    if (!pose || this.ground !== "blocks") return "";
    const met = builderOf(this.app).ahead(pose.position, pose.forward);
    if (!met) return "";
    const one = this.app.store.get().objects.get(met.object);
    return TEXT.walk.ahead(describe(met.state).name, one && nameOf(one));
  }

  private tell(): void {
    for (const call of this.listeners) call();
  }
}

const walkings = new WeakMap<App, Walking>();

export function walkingOf(app: App): Walking {
  const old = walkings.get(app) ?? new Walking(app);
  walkings.set(app, old);
  return old;
}

export function registerWalk(): void {
  registerMode("walk", {
    enter: (app) => walkingOf(app).enter(),
    leave: (app) => walkingOf(app).leave(),
  });
  registerPanel({ id: "walk", title: TEXT.walk.title, place: "right", modes: ["walk"], order: 5, mount: mountChoice });
  registerStagePart({ id: "walking", mount: mountOver });
}

function mountChoice(host: HTMLElement, app: App): void {
  const walking = walkingOf(app);
  const ground = segment<Ground>(
    TEXT.walk.through,
    () => (["blocks", "voxels"] as const).map((value) => ({ value, label: TEXT.walk.grounds[value] })),
    (value) => walking.choose(value),
  );
  const keys = TEXT.walk.keys.map(([key, what]) => h("li", {}, h("kbd", { class: "key" }, key), h("span", {}, what)));
  host.append(ground.node, h("ul", { class: "walk-keys" }, ...keys));
  walking.watch(() => ground.set(walking.ground));
  ground.set(walking.ground);
}

/** Cross hairs, and what they point at. */
function mountOver(host: HTMLElement, app: App): void {
  const walking = walkingOf(app);
  const ahead = h("div", { class: "walk-ahead" });
  const hint = h("div", { class: "walk-hint" }, TEXT.walk.hint);
  const over = h("div", { class: "walk-over", hidden: true }, h("div", { class: "walk-cross" }), ahead, hint);
  host.append(walking.thumbs.node, over);
  mountAsk(host, app, walking);
  app.store.watch(["mode"], ({ mode }) => (over.hidden = mode !== "walk"));
  walking.watch(() => {
    if (!walking.isOn) return;
    fill(ahead, walking.ahead());
    hint.hidden = document.pointerLockElement === app.canvas;
  });
}
