// Standing in a photo: the view flies to its camera, its picture lies over the scene or beside it.

import * as THREE from "three";

import { axesOf, eyeOf, FIELD } from "../view/camera";
import type { Pose } from "../view/sight";
import { h } from "../ui/dom";
import type { App } from "../ui/slots";
import { between, boxOf, orbitAt, poseOf, pyramids, type Frame } from "./place";

export const WAYS = ["photo", "blend", "beside", "scene"] as const;
export type Way = (typeof WAYS)[number];

const FLIGHT_MS = 420;
const LOOKED_AT_M = 2; // What one orbits after leaving a photo.
const CAMERA_M = 0.16;
const COLOURS = { all: 0x6f9fd8, chosen: 0xffa53d };

export class PhotoViewer {
  frame: Frame | null = null;
  way: Way = "photo";
  blend = 0.5;
  private classes = false;
  private readonly picture = h("img", { class: "photo-over", alt: "", hidden: true });
  private readonly lines = new THREE.LineSegments(
    new THREE.BufferGeometry(),
    new THREE.LineBasicMaterial({ color: COLOURS.all }),
  );
  private readonly chosen = new THREE.LineSegments(
    new THREE.BufferGeometry(),
    new THREE.LineBasicMaterial({ color: COLOURS.chosen, depthTest: false }),
  );
  private flight = 0;

  constructor(
    private readonly app: App,
    private readonly changed: () => void,
  ) {
    const { stage, canvas, view } = app;
    canvas.after(this.picture);
    for (const one of [this.lines, this.chosen]) {
      one.visible = false;
      one.frustumCulled = false;
      view.scene.add(one);
    }
    new ResizeObserver(() => this.lay()).observe(stage);
    canvas.addEventListener("pointerdown", (event) => this.takenUp(event), true);
    canvas.addEventListener("wheel", () => this.leave(), { capture: true, passive: true });
    document.addEventListener("keydown", (event) => event.key === "Escape" && this.leave(), true);
    app.store.watch(["mode"], ({ mode }) => mode === "walk" && this.leave());
  }

  /** Show the cameras of all photos in the scene, or none. */
  cameras(frames: readonly Frame[], shown: boolean): void {
    put(this.lines, shown ? frames : []);
    this.app.view.invalidate();
  }

  open(frame: Frame): void {
    const { view } = this.app;
    const from: Pose = view.pose ?? poseOfOrbit(view.orbit);
    this.frame = frame;
    this.load();
    put(this.chosen, [frame]);
    this.chosen.visible = false; // One stands in it.
    this.lay();
    this.fly(from);
    this.changed();
  }

  set(way: Way, blend = this.blend): void {
    if (!this.frame) return;
    this.way = way;
    this.blend = blend;
    this.lay();
    this.stand();
    this.changed();
  }

  /** Show photos in the colours of their classes, or as they were taken. */
  showClasses(on: boolean): void {
    this.classes = on;
    this.load();
  }

  next(): void {
    this.set(WAYS[(WAYS.indexOf(this.way) + 1) % WAYS.length]!);
  }

  leave(): void {
    if (!this.frame) return;
    cancelAnimationFrame(this.flight);
    const { view } = this.app;
    const pose = view.pose;
    put(this.chosen, [this.frame]);
    this.chosen.visible = true;
    this.frame = null;
    this.lay();
    view.pose = null;
    if (pose) view.orbit = orbitAt(pose, LOOKED_AT_M);
    this.changed();
  }

  private load(): void {
    if (!this.frame) return;
    const file = this.classes && !this.frame.is_depth ? "classes" : "picture";
    this.picture.src = `api/photos/${this.frame.n}/${file}.jpg`;
  }

  /** A drag that would turn the view leaves the photo; tools may work in it. */
  private takenUp(event: PointerEvent): void {
    const turns = event.button !== 0 || this.app.store.get().tool === "navigate";
    if (turns) this.leave();
  }

  /** Put the picture over what the view shows of the same place. */
  private lay(): void {
    const { stage, canvas } = this.app;
    const { frame, picture } = this;
    const beside = frame !== null && this.way === "beside";
    stage.classList.toggle("is-beside", beside);
    picture.hidden = !frame || this.way === "scene";
    if (!frame) return;
    const [left, top, wide, tall] = boxOf(frame, beside ? stage.clientWidth / 2 : canvas.clientWidth, canvas.clientHeight);
    const places = { left, top, width: wide, height: tall };
    for (const [name, value] of Object.entries(places)) picture.style.setProperty(name, `${value}px`);
    picture.style.setProperty("opacity", String(this.way === "blend" ? this.blend : 1));
  }

  private stand(): void {
    const { view, canvas } = this.app;
    if (this.frame) view.pose = poseOf(this.frame, canvas.clientWidth / Math.max(canvas.clientHeight, 1));
  }

  private fly(from: Pose): void {
    cancelAnimationFrame(this.flight);
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    const began = performance.now();
    const step = (now: number): void => {
      const { frame } = this;
      const { view, canvas } = this.app;
      if (!frame) return;
      const share = calm ? 1 : Math.min(Math.max((now - began) / FLIGHT_MS, 0), 1);
      view.pose = between(from, poseOf(frame, canvas.clientWidth / Math.max(canvas.clientHeight, 1)), share);
      this.picture.style.setProperty("visibility", share < 1 ? "hidden" : "visible");
      if (share < 1) this.flight = requestAnimationFrame(step);
    };
    step(began);
  }
}

function poseOfOrbit(orbit: Parameters<typeof eyeOf>[0]): Pose {
  const { back, up } = axesOf(orbit);
  return { position: eyeOf(orbit), forward: back.map((one) => -one) as Pose["forward"], up, field: FIELD };
}

function put(lines: THREE.LineSegments, frames: readonly Frame[]): void {
  lines.geometry.dispose();
  lines.geometry = new THREE.BufferGeometry();
  lines.geometry.setAttribute("position", new THREE.BufferAttribute(pyramids(frames, CAMERA_M), 3));
  lines.visible = frames.length > 0;
}
