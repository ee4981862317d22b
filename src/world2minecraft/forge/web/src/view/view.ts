// The picture of a scene on a canvas. It watches the store; nothing is drawn unless something
// changed.

import * as THREE from "three";

import type { State, Store } from "../store";
import type { Run, Vec3 } from "../wire";
import { axesOf, between, eyeOf, FIELD, fitted, halfHeight, rayAt, type Orbit } from "./camera";
import { Chunks } from "./chunks";
import { Controls } from "./controls";
import { VoxelMaterial } from "./material";
import { Overlays } from "./overlay";
import { pickCell, type Hit, type Seen } from "./pick";
import { cellsInPolygon, type DepthLimit, type Point } from "./regions";
import { seenOf } from "./seen";
import { solidTexture } from "./solid";

export interface Picked extends Hit {
  object?: number;
}

const FLIGHT_MS = 260;
const START: Orbit = {
  target: [0, 0, 0],
  azimuth: (-125 * Math.PI) / 180,
  elevation: (42 * Math.PI) / 180,
  distance: 8,
  ortho: false,
};

export class SceneView {
  readonly onFrame: ((ms: number) => void)[] = [];
  readonly controls: Controls;
  readonly scene = new THREE.Scene();
  readonly renderer: THREE.WebGLRenderer;
  private readonly material = new VoxelMaterial();
  private readonly chunks = new Chunks(this.material, () => this.invalidate());
  private readonly overlays = new Overlays();
  private readonly perspective = new THREE.PerspectiveCamera((FIELD * 180) / Math.PI);
  private readonly parallel = new THREE.OrthographicCamera();
  private stand: Orbit = START;
  private flight: { from: Orbit; to: Orbit; start: number } | null = null;
  private seen: Seen = seenOf({ hidden: new Set(), solo: null } as never, [0, 0, 0]);
  private copy: Uint8Array = new Uint8Array(0);
  private asked = 0;
  private waiting: (() => void)[] = [];
  private readonly ends: (() => void)[];

  constructor(
    readonly canvas: HTMLCanvasElement,
    readonly store: Store,
  ) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.scene.add(this.chunks.group, this.overlays.group);
    this.controls = new Controls(canvas, this);
    this.controls.claims = () => store.get().tool !== "navigate";
    const size = new ResizeObserver(() => this.invalidate());
    size.observe(canvas);
    this.ends = [
      () => size.disconnect(),
      store.watch(["scene", "labels", "view", "theme"], (state, changed) => {
        if (changed.has("scene") || changed.has("labels")) this.takeVolume(state);
        this.takeView(state);
        this.invalidate();
      }),
    ];
  }

  get orbit(): Orbit {
    return this.stand;
  }

  set orbit(orbit: Orbit) {
    this.flight = null;
    this.stand = orbit;
    this.invalidate();
  }

  /** The first drawn cell under a pixel of the canvas, from its top left. */
  pick(x: number, y: number): Picked | null {
    const state = this.store.get();
    if (!state.scene || !state.labels.length) return null;
    const ray = this.rayInCells(x, y);
    const volume = { labels: state.labels, shape: state.scene.shape };
    const hit = pickCell(volume, this.seen, ray.from, ray.direction);
    if (!hit) return null;
    const object = state.instance[hit.flat];
    return object ? { ...hit, object } : hit;
  }

  /** Where a point in metres is on the canvas, in pixels; null: behind the camera. */
  project(point: Vec3): [number, number] | null {
    this.placeCamera();
    const at = new THREE.Vector3(...point).project(this.camera);
    if (at.z > 1 || at.z < -1) return null;
    return [((at.x + 1) / 2) * this.canvas.clientWidth, ((1 - at.y) / 2) * this.canvas.clientHeight];
  }

  /** Where the ray through a pixel meets the plane `axis` = `at` metres; null: it does not. */
  toRoom(x: number, y: number, plane: { axis: 0 | 1 | 2; at: number }): Vec3 | null {
    const { from, direction } = this.ray(x, y);
    const t = (plane.at - from[plane.axis]) / direction[plane.axis];
    if (!Number.isFinite(t) || t < 0) return null;
    return from.map((value, i) => value + t * direction[i]!) as Vec3;
  }

  /** The point of the scene under a pixel, in metres. */
  pointAt(x: number, y: number): Vec3 | null {
    const scene = this.store.get().scene;
    const hit = this.pick(x, y);
    if (!hit || !scene) return null;
    const { from, direction } = this.ray(x, y);
    return from.map((value, i) => value + hit.t * direction[i]!) as Vec3;
  }

  /** Flat numbers of the drawn cells behind a rectangle of the canvas. */
  cellsInRect(x0: number, y0: number, x1: number, y1: number, limit: DepthLimit = "surface"): number[] {
    return this.lasso([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], limit);
  }

  /** Flat numbers of the drawn cells behind a polygon of the canvas. */
  lasso(polygon: readonly Point[], limit: DepthLimit = "surface"): number[] {
    const { scene, labels } = this.store.get();
    if (!scene || polygon.length < 3) return [];
    const { origin_m: origin, voxel_m: voxel, shape } = scene;
    this.placeCamera();
    const eye = this.nearCell();
    const { back } = axesOf(this.stand);
    const project = (cell: Vec3) => this.project(cell.map((c, i) => origin[i]! + c * voxel) as Vec3);
    const rayTo = (cell: Vec3) => {
      const from = this.stand.ortho ? (cell.map((c, i) => c + back[i]! * 1e4) as Vec3) : eye;
      return { from, direction: cell.map((c, i) => c - from[i]!) as Vec3 };
    };
    return cellsInPolygon({ labels, shape }, this.seen, polygon, limit, project, rayTo);
  }

  /** Light up cells under a name, or no longer (null). */
  setOverlay(name: string, runs: readonly Run[] | null, colour = "#ffffff"): void {
    const { scene } = this.store.get();
    if (scene) this.overlays.set(name, runs, scene.shape, colour);
    this.invalidate();
  }

  /** Fly to where the whole scene is in view. */
  frame(): void {
    const { scene } = this.store.get();
    if (!scene) return;
    const high = scene.origin_m.map((o, i) => o + scene.shape[i]! * scene.voxel_m) as Vec3;
    this.flyTo(fitted(this.goal, scene.origin_m, high, this.aspect));
  }

  /** Fly to where a box, in metres, fills the view. */
  focus(box: { low: Vec3; high: Vec3 }): void {
    const room = box.low.map((l, i) => Math.max((box.high[i]! - l) * 0.35, 0.15));
    const low = box.low.map((l, i) => l - room[i]!) as Vec3;
    const high = box.high.map((h, i) => h + room[i]!) as Vec3;
    this.flyTo(fitted(this.goal, low, high, this.aspect));
  }

  /** Look along an axis: 0, 1 from -x, -y; 2 from the top; `back` from the other side. */
  lookAlong(axis: 0 | 1 | 2, back = false): void {
    const half = Math.PI / 2;
    const side = back ? -1 : 1;
    const [azimuth, elevation] =
      axis === 2 ? [-half, side * (half - 1e-4)] : [axis === 0 ? (back ? 0 : Math.PI) : -side * half, 0];
    this.flyTo({ ...this.goal, azimuth: azimuth!, elevation: elevation! });
  }

  flyTo(to: Orbit): void {
    this.flight = { from: { ...this.stand, ortho: to.ortho }, to, start: performance.now() };
    this.invalidate();
  }

  invalidate(): void {
    if (!this.asked) this.asked = requestAnimationFrame((now) => this.draw(now));
  }

  stats(): { quads: number; bytes: number } {
    return { quads: this.chunks.quads, bytes: this.chunks.bytes };
  }

  /** Resolves when everything is meshed and drawn and the camera stands still. */
  idle(): Promise<void> {
    return new Promise((resolve) => {
      this.waiting.push(resolve);
      this.invalidate();
    });
  }

  dispose(): void {
    cancelAnimationFrame(this.asked);
    for (const end of this.ends) end();
    this.controls.dispose();
    this.chunks.dispose();
    this.material.dispose();
    this.renderer.dispose();
  }

  private get camera(): THREE.PerspectiveCamera | THREE.OrthographicCamera {
    return this.stand.ortho ? this.parallel : this.perspective;
  }

  private get goal(): Orbit {
    return this.flight?.to ?? this.stand;
  }

  private get aspect(): number {
    return this.canvas.clientWidth / Math.max(this.canvas.clientHeight, 1) || 1;
  }

  private ray(x: number, y: number): { from: Vec3; direction: Vec3 } {
    return rayAt(this.stand, x, y, this.canvas.clientWidth, this.canvas.clientHeight);
  }

  private rayInCells(x: number, y: number): { from: Vec3; direction: Vec3 } {
    const { scene } = this.store.get();
    const { from, direction } = this.ray(x, y);
    const cells = from.map((v, i) => (v - scene!.origin_m[i]!) / scene!.voxel_m) as Vec3;
    return { from: cells, direction: direction.map((d) => d / scene!.voxel_m) as Vec3 };
  }

  private takeVolume({ scene, labels }: Readonly<State>): void {
    if (!scene || labels.length !== scene.shape.reduce((a, b) => a * b, 1)) return;
    const { shape, voxel_m, origin_m } = scene;
    const same = this.copy.length === labels.length;
    if (same) {
      const flats = changedCells(this.copy, labels);
      if (flats.length) this.chunks.touch(flats, this.nearCell());
      return;
    }
    this.copy = labels.slice();
    this.material.setPlace(voxel_m, origin_m, shape);
    this.overlays.setPlace(voxel_m, origin_m);
    this.overlays.clear();
    const high = origin_m.map((o, i) => o + shape[i]! * voxel_m) as Vec3;
    this.orbit = fitted(START, origin_m, high, this.aspect);
    this.chunks.load(this.copy, shape, voxel_m, origin_m, this.nearCell());
  }

  private nearCell(): Vec3 {
    const { scene } = this.store.get();
    return eyeOf(this.stand).map((v, i) => (v - scene!.origin_m[i]!) / scene!.voxel_m) as Vec3;
  }

  private takeView({ scene, view, theme }: Readonly<State>): void {
    this.scene.background = new THREE.Color(theme === "dark" ? 0x16181d : 0xf1f2f4);
    if (!scene) return;
    this.seen = seenOf(view, scene.shape);
    const colours: Vec3[] = [];
    for (const { id, colour } of scene.classes) colours[id] = colour;
    this.material.setClasses(colours, this.seen.visible);
    this.material.setBox(this.seen.low, this.seen.high);
    this.material.uniforms.shrink.value = view.voxelSize;
    this.chunks.setStyle(view.voxelSize < 0.995 ? "cubes" : "greedy", this.nearCell());
    this.material.uniforms.solid.value?.dispose();
    this.material.uniforms.solid.value = solidTexture({ labels: this.copy, shape: scene.shape }, this.seen.visible);
    const shadows = this.material.uniforms.solid.value !== null;
    this.material.setParts({ edges: view.edges, shadows, opacity: view.opacity });
  }

  private placeCamera(): void {
    const { stand, camera } = this;
    const { back, up } = axesOf(stand);
    const size = 1000;
    if (camera instanceof THREE.PerspectiveCamera) {
      camera.aspect = this.aspect;
      camera.near = Math.max(stand.distance / 200, 0.01);
      camera.far = stand.distance + size;
    } else {
      const half = halfHeight(stand);
      [camera.top, camera.bottom] = [half, -half];
      [camera.left, camera.right] = [-half * this.aspect, half * this.aspect];
      [camera.near, camera.far] = [-size, size];
    }
    camera.up.set(...up);
    camera.position.set(...eyeOf(stand));
    camera.lookAt(camera.position.x - back[0], camera.position.y - back[1], camera.position.z - back[2]);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld(true);
  }

  private draw(now: number): void {
    this.asked = 0;
    if (this.flight) this.fly(now);
    this.resize();
    this.placeCamera();
    const started = performance.now();
    if (this.copy.length) {
      const { back } = axesOf(this.stand);
      this.chunks.aim(this.stand.ortho ? null : this.nearCell(), back.map((b) => -b) as Vec3);
    }
    this.renderer.render(this.scene, this.camera);
    const ms = performance.now() - started;
    for (const call of this.onFrame) call(ms);
    if (this.flight) this.invalidate();
    else if (this.chunks.settled) for (const resolve of this.waiting.splice(0)) resolve();
  }

  private fly(now: number): void {
    const { from, to, start } = this.flight!;
    const share = Math.min(Math.max((now - start) / FLIGHT_MS, 0), 1);
    this.stand = between(from, to, share);
    if (share === 1) this.flight = null;
  }

  private resize(): void {
    const { clientWidth: wide, clientHeight: tall } = this.canvas;
    const size = this.renderer.getSize(new THREE.Vector2());
    if (size.x !== wide || size.y !== tall) this.renderer.setSize(wide, tall, false);
  }
}

/** Flat numbers of the cells that differ; `into` is made equal. */
export function changedCells(into: Uint8Array, now: Uint8Array): number[] {
  const found: number[] = [];
  for (let flat = 0; flat < now.length; flat++) {
    if (into[flat] === now[flat]) continue;
    found.push(flat);
    into[flat] = now[flat]!;
  }
  return found;
}
