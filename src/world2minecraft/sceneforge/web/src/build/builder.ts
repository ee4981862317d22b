// The Build mode's state, shared with Walk: blocks in the picture, what is cut open, what is picked.

import * as THREE from "three";

import type { State } from "../store";
import type { App } from "../ui/slots";
import { axesOf, eyeOf } from "../view/camera";
import type { Picked, SceneView } from "../view/view";
import type { Vec3 } from "../wire";
import { BlocksView } from "./blocks_view";
import { Loader } from "./loader";
import { CEILING_CUT, cutsFrom, type BuildFacts, type Met } from "./mesh";

const CEILING = 1;
const CLASSES = 12;

export interface Clicked {
  state: string; // of the block; empty for a display entity
  cell: Vec3; // of the build
  object: number; // 0 for none
}

export class Builder {
  readonly blocks = new BlocksView<BuildFacts>();
  readonly loader: Loader;
  readonly view: SceneView;
  cutOpen = true;
  clicked: Clicked | null = null;
  private wanted = false; // blocks are to be in the picture
  private whole = false; // nothing is hidden: someone is inside
  private listeners = new Set<() => void>();

  constructor(readonly app: App) {
    this.view = app.view as unknown as SceneView;
    this.loader = new Loader(app);
    this.view.scene.add(this.blocks.group);
    this.view.onFrame.push(() => this.wanted && this.hide());
    this.loader.watch(() => this.take());
    app.store.watch(["scene", "touched"], () => this.wanted && this.loader.refresh());
    app.store.watch(["view"], () => this.wanted && this.hide());
    app.store.watch(["selectedObjects", "objects"], () => this.outline());
  }

  watch(call: () => void): void {
    this.listeners.add(call);
  }

  /** Put the blocks into the picture in the place of the voxels, or take them out. */
  show(on: boolean, whole = false): void {
    this.wanted = on;
    this.whole = whole;
    if (on) this.loader.refresh(true);
    this.click(null);
    this.outline();
    this.swap();
    this.hide();
  }

  wish(change: Partial<Loader["wish"]>): void {
    this.loader.wish = { ...this.loader.wish, ...change };
    this.click(null);
    if (this.wanted) this.loader.refresh(true);
    this.tell();
  }

  setCutOpen(on: boolean): void {
    this.cutOpen = on;
    this.hide();
    this.tell();
  }

  /** Remember the block under a pixel; its object is selected. */
  clickAt(x: number, y: number): void {
    const ray = this.rayAt(x, y);
    const met = ray && this.blocks.meet(ray.from, ray.direction);
    this.click(met ? this.factsOf(met) : null);
    const { objects } = this.app.store.get();
    const object = this.clicked?.object ?? 0;
    this.app.store.set({ selectedObjects: new Set(objects.has(object) ? [object] : []) });
  }

  /** What is in the middle of what someone sees who walks. */
  ahead(from: Vec3, direction: Vec3): Clicked | null {
    const met = this.blocks.meet(from, direction);
    return met && this.factsOf(met);
  }

  private factsOf({ quad, cell }: Met): Clicked {
    const mesh = this.blocks.mesh!;
    const state = mesh.facts.palette[mesh.state[quad]!] ?? "";
    return { state, cell, object: mesh.instance[quad]! };
  }

  private click(clicked: Clicked | null): void {
    this.clicked = clicked;
    const box = clicked?.state && { low: clicked.cell, high: clicked.cell.map((v) => v + 1) as Vec3 };
    this.blocks.outline("block", box ? [box] : []);
    this.tell();
    this.view.invalidate();
  }

  private take(): void {
    const { mesh } = this.loader;
    if (mesh && mesh !== this.blocks.mesh) {
      this.blocks.show(mesh);
      this.click(null);
      this.outline();
      this.swap();
      this.hide();
    }
    this.tell();
  }

  /** Until the first blocks are there, the voxels stay in the picture. */
  private swap(): void {
    const on = this.wanted && this.blocks.mesh !== null;
    this.blocks.group.visible = on;
    this.view.showCells(!on);
    this.view.picker = on ? (ray) => this.pick(ray.from, ray.direction) : null;
  }

  private hide(): void {
    const { view } = this.app.store.get();
    const hidden = { classes: this.whole ? 0 : hiddenClasses(view), cuts: this.whole ? 0 : this.cuts(view) };
    const { classes, cuts } = this.blocks.hidden;
    if (hidden.classes === classes && hidden.cuts === cuts) return;
    this.blocks.hide(hidden);
    this.view.invalidate();
  }

  private cuts(view: State["view"]): number {
    const ceiling = view.hidden.has(CEILING) ? CEILING_CUT : 0;
    const orbit = this.view.orbit;
    return this.cutOpen && !this.isInside(eyeOf(orbit)) ? cutsFrom(axesOf(orbit).back) | ceiling : ceiling;
  }

  /** Whether one looks from within the room. */
  private isInside(eye: Vec3): boolean {
    const { scene } = this.app.store.get();
    if (!scene) return false;
    return eye.every((v, i) => {
      const low = scene.origin_m[i as 0];
      return v > low && v < low + scene.shape[i as 0] * scene.voxel_m;
    });
  }

  private outline(): void {
    const { mesh } = this.blocks;
    const { selectedObjects } = this.app.store.get();
    const boxes = mesh && !this.whole ? [...selectedObjects].flatMap((id) => mesh.boxOf(id) ?? []) : [];
    this.blocks.outline("object", boxes);
    this.view.invalidate();
  }

  private rayAt(x: number, y: number): { from: Vec3; direction: Vec3 } | null {
    let found: { from: Vec3; direction: Vec3 } | null = null;
    const { picker } = this.view;
    this.view.picker = (ray) => {
      found = ray;
      return null;
    };
    this.view.pick(x, y);
    this.view.picker = picker;
    return found;
  }

  /** For the pointer: the voxel that lies where a block was met. */
  private pick(from: Vec3, direction: Vec3): Picked | null {
    const { scene } = this.app.store.get();
    const met = this.blocks.meet(from, direction);
    if (!met || !scene) return null;
    const inside = met.t + 0.01 / new THREE.Vector3(...direction).length();
    const cell = from.map((v, i) => {
      const at = (v + inside * direction[i as 0] - scene.origin_m[i as 0]) / scene.voxel_m;
      return Math.min(Math.max(Math.floor(at), 0), scene.shape[i as 0] - 1);
    }) as Vec3;
    const flat = (cell[0] * scene.shape[1] + cell[1]) * scene.shape[2] + cell[2];
    const object = this.factsOf(met).object;
    return { cell, flat, face: 2, t: met.t, ...(object && { object }) };
  }

  private tell(): void {
    for (const call of this.listeners) call();
  }
}

function hiddenClasses(view: State["view"]): number {
  let bits = 0;
  for (let id = 0; id < CLASSES; id++) {
    if (view.solo === null ? view.hidden.has(id) : id !== view.solo) bits |= 1 << id;
  }
  return bits;
}
