// The picture of a shared room: blocks cut open towards whoever looks from outside, whole for one
// who is inside.

import * as THREE from "three";

import { BlocksView } from "../build/blocks_view";
import { SKIES, type Light } from "../build/material";
import { CEILING_CUT, cutsFrom, type BlockMesh, type Met } from "../build/mesh";
import { axesOf, eyeOf, fitted, type Orbit } from "../view/camera";
import { snug, type Margins } from "./snug";
import { Controls } from "../view/controls";
import { Frames } from "../view/frames";
import { Quality } from "../view/quality";
import { Sight, type Pose } from "../view/sight";
import type { Vec3 } from "../wire";

const FLIGHT_MS = 650;
const ELEVATIONS = { start: 0.74, least: 0.05, most: 1.5 }; // radians
const NEAREST_M = 0.6;
const MARGINS = { wide: { left: 0.07, right: 0.07, top: 0.09, bottom: 0.2 }, tall: { left: 0.04, right: 0.04, top: 0.14, bottom: 0.17 } };

export interface Box {
  low: Vec3;
  high: Vec3;
}

export class RoomView {
  readonly scene = new THREE.Scene();
  readonly blocks = new BlocksView();
  readonly box: Box; // of all that is drawn, in metres
  /** Called before each frame, with its time. */
  readonly onFrame: ((now: number) => void)[] = [];
  ground = 0xf1f2f4; // behind the room, seen from outside by day
  isInside = false;
  private readonly sight: Sight;
  private readonly renderer: THREE.WebGLRenderer;
  private readonly frames: Frames;
  private farthest = Infinity; // metres from what is looked at
  private size = "";
  private programs = -1;

  constructor(
    readonly canvas: HTMLCanvasElement,
    mesh: BlockMesh,
    azimuth: number,
  ) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: false });
    this.renderer.debug.checkShaderErrors = import.meta.env.DEV;
    this.blocks.show(mesh);
    this.blocks.group.visible = true;
    this.scene.add(this.blocks.group);
    this.box = this.boxOf(mesh);
    const start = { target: [0, 0, 0] as Vec3, azimuth, elevation: ELEVATIONS.start, distance: 8, ortho: false };
    this.sight = new Sight(start);
    this.frames = new Frames(new Quality(), (fineness, now) => this.paint(fineness.scale, now));
    new Controls(canvas, this);
    new ResizeObserver(() => this.resized()).observe(canvas);
    this.resized();
    canvas.addEventListener("webglcontextrestored", () => this.invalidate());
  }

  get orbit(): Orbit {
    return this.sight.orbit;
  }

  set orbit(orbit: Orbit) {
    const elevation = Math.min(Math.max(orbit.elevation, ELEVATIONS.least), ELEVATIONS.most);
    const distance = Math.min(Math.max(orbit.distance, NEAREST_M), this.farthest);
    const target = orbit.target.map((v, i) => Math.min(Math.max(v, this.box.low[i as 0]), this.box.high[i as 0])) as Vec3;
    this.sight.orbit = { ...orbit, elevation, distance, target };
    this.invalidate();
  }

  get pose(): Pose | null {
    return this.sight.pose;
  }

  set pose(pose: Pose | null) {
    this.sight.pose = pose;
    this.invalidate();
  }

  get aspect(): number {
    return this.sight.aspect;
  }

  setLight(light: Light): void {
    this.blocks.material.setLight(light);
    this.invalidate();
  }

  /** What is under a pixel of the canvas. */
  meetAt(x: number, y: number): Met | null {
    const { from, direction } = this.sight.ray(x, y);
    return this.blocks.meet(from, direction);
  }

  pointAt(x: number, y: number): Vec3 | null {
    const { from, direction } = this.sight.ray(x, y);
    const met = this.blocks.meet(from, direction);
    return met && (from.map((v, i) => v + met.t * direction[i as 0]) as Vec3);
  }

  project(point: Vec3): [number, number] | null {
    return this.sight.project(point);
  }

  /** Fly to where the whole room is in view. */
  frame(): void {
    this.fly(this.whole(this.sight.goal));
  }

  /** Fly to a box, in metres, with some of the room around it. */
  focus({ low, high }: Box): void {
    const room = Math.max(0.5, 0.6 * Math.max(...high.map((h, i) => h - low[i as 0])));
    const goal = { ...this.sight.goal, elevation: Math.max(this.sight.goal.elevation, 0.55) };
    this.fly(fitted(goal, low.map((v) => v - room) as Vec3, high.map((v) => v + room) as Vec3, this.aspect));
  }

  invalidate(): void {
    this.frames.invalidate();
  }

  idle(): Promise<void> {
    return this.frames.idle();
  }

  private fly(to: Orbit): void {
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.sight.fly(to, performance.now(), calm, FLIGHT_MS);
    this.invalidate();
  }

  /** All that is drawn from that side, as large as it fits between the parts of the page. */
  private whole(from: Orbit = this.sight.orbit): Orbit {
    const orbit = { ...from, elevation: ELEVATIONS.start };
    const margins: Margins = this.aspect > 1 ? MARGINS.wide : MARGINS.tall;
    const found = snug(orbit, this.corners(cutsFrom(axesOf(orbit).back) | CEILING_CUT), this.aspect, margins);
    this.farthest = found.distance * 2.5;
    return found;
  }

  /** The corners of all quads that these cuts leave, in metres. */
  private corners(cuts: number): Float32Array {
    const mesh = this.blocks.mesh!;
    const matrix = this.blocks.group.matrix.elements;
    const found = new Float32Array(mesh.position.length);
    let count = 0;
    for (let quad = 0; quad < mesh.quads; quad++) {
      if (mesh.isHidden(quad, { classes: 0, cuts })) continue;
      for (let at = quad * 12; at < quad * 12 + 12; at += 3) {
        const [x, y, z] = [mesh.position[at]!, mesh.position[at + 1]!, mesh.position[at + 2]!];
        for (let i = 0; i < 3; i++) found[count++] = matrix[i]! * x + matrix[4 + i]! * y + matrix[8 + i]! * z + matrix[12 + i]!;
      }
    }
    return found.subarray(0, count);
  }

  private boxOf({ position }: BlockMesh): Box {
    const low: Vec3 = [Infinity, Infinity, Infinity];
    const high: Vec3 = [-Infinity, -Infinity, -Infinity];
    for (let at = 0; at < position.length; at++) {
      const axis = (at % 3) as 0 | 1 | 2;
      low[axis] = Math.min(low[axis], position[at]!);
      high[axis] = Math.max(high[axis], position[at]!);
    }
    const [one, two] = [this.blocks.toRoom(low), this.blocks.toRoom(high)];
    return { low: one.map((v, i) => Math.min(v, two[i as 0])) as Vec3, high: one.map((v, i) => Math.max(v, two[i as 0])) as Vec3 };
  }

  private resized(): void {
    const had = this.sight.aspect;
    this.sight.resize(this.canvas.clientWidth, this.canvas.clientHeight);
    if (Math.abs(had - this.sight.aspect) > 0.02 && !this.sight.pose) this.sight.orbit = this.whole();
    this.invalidate();
  }

  /** From outside the ceiling and the near walls are not drawn. */
  private cuts(): number {
    if (this.sight.pose) return this.isInside ? 0 : CEILING_CUT;
    const { orbit } = this.sight;
    const within = eyeOf(orbit).every((v, i) => v > this.box.low[i as 0] && v < this.box.high[i as 0]);
    return within ? CEILING_CUT : cutsFrom(axesOf(orbit).back) | CEILING_CUT;
  }

  private paint(scale: number, now: number): { again: boolean; settled: boolean; more: boolean; usual: boolean } {
    this.sight.step(now);
    const { clientWidth: wide, clientHeight: tall } = this.canvas;
    const ratio = Math.min(devicePixelRatio * scale, Math.max(devicePixelRatio, 2));
    const size = [wide, tall, ratio].join();
    const same = size === this.size;
    if (!same) this.renderer.setDrawingBufferSize(wide, tall, ratio);
    this.size = size;
    for (const call of this.onFrame) call(now);
    this.blocks.hide({ classes: 0, cuts: this.cuts() });
    const { light } = this.blocks.material;
    const background = this.isInside || light === "night" ? SKIES[light] : this.ground;
    this.scene.background = new THREE.Color(background);
    this.renderer.render(this.scene, this.sight.camera());
    if (!performance.getEntriesByName("room-first").length) performance.mark("room-first");
    const programs = this.renderer.info.programs?.length ?? 0;
    const usual = same && programs === this.programs;
    this.programs = programs;
    return { again: this.sight.flying, settled: true, more: false, usual };
  }
}
