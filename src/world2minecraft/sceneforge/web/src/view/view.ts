// The picture of a scene on a canvas. It watches the store; nothing is drawn unless something
// changed.

import * as THREE from "three";

import type { State, Store } from "../store";
import type { Run, Vec3 } from "../wire";
import { fitted } from "./camera";
import { Caps } from "./caps";
import { meshOf, quadIndex } from "./chunk";
import { Chunks } from "./chunks";
import { Compass } from "./compass";
import { Controls } from "./controls";
import { Fields, type Difference } from "./fields";
import { Frames, type Painted } from "./frames";
import { Glass, PASSES } from "./glass";
import { Ground } from "./ground";
import { Look } from "./look";
import { Looking, START } from "./looking";
import { Markers } from "./markers";
import { VoxelMaterial } from "./material";
import { Overlays } from "./overlay";
import { Quality, type Fineness } from "./quality";
import { Reach, type Picked, type Ray } from "./reach";
import type { DepthLimit, Point } from "./regions";
import { changedCells } from "./volume";
import "./view.css";

export type { Picked } from "./reach";
export type { Difference } from "./fields";
export type { DepthLimit } from "./regions";
export type { Pose } from "./sight";

const OVERLAP_PX = 0.12; // of quads: under what is seen
const GROUND = { dark: 0x16181d, light: 0xf1f2f4 };

export class SceneView extends Looking {
  /** Called after each frame with how long frames take, in milliseconds. */
  readonly onFrame: ((ms: number) => void)[] = [];
  readonly controls: Controls;
  readonly scene = new THREE.Scene(); // in metres of the room, z up; others may add to it
  readonly renderer: THREE.WebGLRenderer;
  private readonly material = new VoxelMaterial();
  private readonly chunks = new Chunks(this.material, () => this.invalidate());
  private readonly look = new Look(
    this.material,
    this.chunks,
    new Fields(this.material, () => this.refresh()),
    new Caps(this.chunks.group, this.material),
  );
  private readonly markers = new Markers();
  private readonly ground = new Ground();
  private readonly overlays = new Overlays();
  private readonly reach: Reach;
  private readonly compass: Compass;
  private readonly frames: Frames;
  private readonly glass: Glass;
  private copy: Uint8Array = new Uint8Array(0);
  private place = "";
  private size = "";
  private work = ""; // that the last frame had done: programs, meshes, size
  private drawn: Fineness = { scale: 1, coarse: 0 };
  private readonly ends: (() => void)[];

  constructor(
    readonly canvas: HTMLCanvasElement,
    readonly store: Store,
  ) {
    super();
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: false });
    this.renderer.debug.checkShaderErrors = import.meta.env.DEV; // It waits for the compiler.
    this.frames = new Frames(new Quality(), (...how) => this.paint(...how));
    this.glass = new Glass(this.renderer);
    this.scene.add(this.ground.lines, this.chunks.group, this.overlays.group, this.markers.group);
    this.reach = new Reach(store, this.sight, () => this.look.seen);
    this.compass = new Compass(canvas, (side) => this.lookFrom(side));
    this.controls = new Controls(canvas, this);
    this.controls.claims = () => store.get().tool !== "navigate";
    this.warm();
    const size = new ResizeObserver(() => this.invalidate());
    size.observe(canvas);
    canvas.addEventListener("webglcontextrestored", () => this.invalidate());
    this.ends = [
      () => size.disconnect(),
      store.watch(["scene", "labels", "view", "theme"], (state, changed) => {
        if (changed.has("scene") || changed.has("labels")) this.takeVolume(state);
        this.takeTheme(state);
        this.refresh();
      }),
      store.watch(["objects", "selectedObjects", "mode", "view", "theme", "scene"], (state) => {
        this.markers.take(state);
        this.invalidate();
      }),
    ];
  }

  get picker(): ((ray: Ray) => Picked | null) | null {
    return this.reach.picker;
  }

  /** Finds what a ray in metres meets where something else than the voxels is drawn. */
  set picker(find: ((ray: Ray) => Picked | null) | null) {
    this.reach.picker = find;
  }

  /** The first drawn cell under a pixel of the canvas, from its top left. */
  pick(x: number, y: number): Picked | null {
    this.measure();
    return this.reach.pick(x, y);
  }

  /** The point of the scene under a pixel, in metres. */
  pointAt(x: number, y: number): Vec3 | null {
    this.measure();
    return this.reach.pointAt(x, y);
  }

  /** Where the ray through a pixel meets the plane `axis` = `at` metres; null: it does not. */
  toRoom(x: number, y: number, plane: { axis: 0 | 1 | 2; at: number }): Vec3 | null {
    this.measure();
    return this.reach.toRoom(x, y, plane);
  }

  /** Flat numbers of the drawn cells behind a rectangle of the canvas. */
  cellsInRect(x0: number, y0: number, x1: number, y1: number, limit: DepthLimit = "surface"): number[] {
    return this.lasso([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], limit);
  }

  /** Flat numbers of the drawn cells behind a polygon of the canvas. */
  lasso(polygon: readonly Point[], limit: DepthLimit = "surface"): number[] {
    this.measure();
    return this.reach.lasso(polygon, limit);
  }

  /** Light up cells under a name, or no longer (null). */
  setOverlay(name: string, runs: readonly Run[] | null, colour = "#ffffff", opacity?: number): void {
    const { scene } = this.store.get();
    if (scene) this.overlays.set(name, runs, scene.shape, colour, opacity);
    this.invalidate();
  }

  /** Draw the voxels, or leave the picture to what others put into `scene`. */
  showCells(on: boolean): void {
    this.chunks.group.visible = on;
    this.overlays.group.visible = on;
    this.invalidate();
  }

  /** What "difference" shows: against another scene; null: nothing. */
  setDifference(difference: Difference | null): void {
    this.look.fields.setDifference(difference, this.copy.length);
    this.setOverlay("removed", difference?.removed ?? null, "#ff5d5d");
    this.refresh();
  }

  invalidate(): void {
    this.frames.invalidate();
  }

  /** Resolves when everything is meshed and drawn in full and the camera stands still. */
  idle(): Promise<void> {
    return this.frames.idle();
  }

  /** What the picture costs. */
  stats(): { quads: number; bytes: number; made: number; ms: number; drawn: Fineness } {
    const { quads, bytes, made } = this.chunks;
    return { quads, bytes, made, ms: this.frames.lastMs, drawn: this.drawn };
  }

  dispose(): void {
    for (const end of this.ends) end();
    for (const part of [this.frames, this.glass, this.compass, this.markers, this.ground, this.controls, this.chunks, this.material, this.renderer]) part.dispose();
  }

  private takeVolume({ scene, labels }: Readonly<State>): void {
    if (!scene || labels.length !== scene.shape.reduce((a, b) => a * b, 1)) return;
    const { shape, voxel_m, origin_m } = scene;
    const place = [scene.name, voxel_m, ...origin_m, ...shape].join();
    if (place === this.place) {
      const flats = changedCells(this.copy, labels);
      if (!flats.length) return;
      this.chunks.touch(flats);
      this.look.forget();
      return;
    }
    this.place = place;
    this.copy = this.reach.labels = labels.slice();
    this.material.setPlace(voxel_m, origin_m, shape);
    this.overlays.setPlace(voxel_m, origin_m);
    this.overlays.clear();
    this.look.forget();
    this.chunks.load(this.copy, shape, voxel_m, origin_m);
    const { low, high } = this.box()!;
    this.sight.orbit = fitted(START, low, high, this.measure().aspect);
  }

  /** Have the shader compiled while the scene is still on its way: a quad that covers no pixel. */
  private warm(): void {
    this.material.setParts({ edges: true, shadows: true, opacity: 1, by: "class" });
    const quad = meshOf([0, 0, 0], { words: new Uint32Array(8), starts: [] }, quadIndex(1), this.material.greedy);
    quad.geometry.addGroup(0, 6, 0);
    quad.frustumCulled = false;
    this.renderer.render(new THREE.Scene().add(quad), this.sight.camera());
    quad.geometry.dispose();
  }

  private refresh(): void {
    this.look.take(this.store.get(), this.copy);
    this.invalidate();
  }

  private takeTheme({ theme }: Readonly<State>): void {
    this.scene.background = new THREE.Color(GROUND[theme]);
    const box = this.box();
    if (box) this.ground.take(box.low, box.high, theme === "dark");
  }

  private paint(wanted: Fineness, now: number, pass: number | null): Painted {
    const clear = this.store.get().view.opacity < 1 && this.chunks.group.visible;
    const fineness = clear && pass !== null ? { scale: 1, coarse: 0 } : wanted;
    this.drawn = fineness;
    this.sight.step(now);
    this.resize(fineness.scale);
    const camera = this.sight.camera();
    if (this.copy.length && this.store.get().scene) { // A room may have been closed just now.
      this.aim(camera, fineness.coarse);
      this.markers.dim((center) => this.reach.isCovered(center));
    }
    this.compass.turn(this.sight.pose || !this.copy.length ? null : this.sight.axes);
    if (clear && pass !== null) this.addPass(pass, camera);
    else this.renderer.render(this.scene, camera);
    const work = [this.renderer.info.programs?.length, this.chunks.made, fineness.scale].join();
    const usual = work === this.work;
    this.work = work;
    if (this.copy.length) markOnce("scene-first");
    if (this.copy.length && this.chunks.settled) markOnce("scene-whole");
    for (const call of [...this.onFrame]) call(this.frames.lastMs);
    return { again: this.sight.flying, settled: this.chunks.settled, usual, more: clear && pass !== PASSES - 1 };
  }

  /** A frame of those that are averaged, and the marks, which are not, over them. */
  private addPass(pass: number, camera: THREE.Camera): void {
    this.material.uniforms.grain.value = pass;
    this.markers.group.visible = false;
    this.glass.add(pass, this.scene, camera);
    this.material.uniforms.grain.value = 0;
    this.markers.group.visible = true;
    this.renderer.autoClear = false;
    this.renderer.render(this.markers.group, camera);
    this.renderer.autoClear = true;
  }

  private aim(camera: THREE.Camera, coarse: number): void {
    const { voxel_m } = this.store.get().scene!;
    const matrix = new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    this.material.setOverlap(OVERLAP_PX / this.sight.pixels(1) / voxel_m, this.sight.isParallel);
    this.chunks.aim({
      eye: this.sight.isParallel ? null : this.reach.inCells(this.sight.eye),
      direction: this.sight.axes.back.map((b) => -b) as Vec3,
      frustum: new THREE.Frustum().setFromProjectionMatrix(matrix.multiply(this.chunks.group.matrix)),
      pixels: (distance) => this.sight.pixels(distance * voxel_m) * voxel_m,
      coarse,
    });
  }

  private resize(scale: number): void {
    const { clientWidth: wide, clientHeight: tall } = this.canvas;
    this.measure();
    const ratio = Math.min(devicePixelRatio * scale, Math.max(devicePixelRatio, 2));
    const size = [wide, tall, ratio].join();
    if (size === this.size) return;
    this.size = size;
    this.renderer.setDrawingBufferSize(wide, tall, ratio); // Once: each change waits for the GPU.
    this.markers.resize(wide, tall);
  }
}

/** For whoever measures: when a picture was first there. */
function markOnce(name: string): void {
  if (!performance.getEntriesByName(name).length) performance.mark(name);
}
