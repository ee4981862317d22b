// What a running reconstruction has found so far: cameras, points, cells, things, blocks, each in
// place of what it was made of. The server's live_layers.py sends the layers.

import * as THREE from "three";

import { BlocksView } from "../build/blocks_view";
import { BlockMesh, CEILING_CUT, cutsFrom } from "../build/mesh";
import { Packet } from "../build/packet";
import { TEXT } from "../text";
import { fill, h } from "../ui/dom";
import { axesOf, eyeOf, fitted, FIELD, turned, type Orbit } from "../view/camera";
import { Controls } from "../view/controls";
import type { Vec3 } from "../wire";
import { getJson } from "./api";

export const LAYERS = ["cameras", "points", "cells", "things", "blocks"] as const;
export type Layer = (typeof LAYERS)[number];

interface Thing {
  name: string;
  center_m: Vec3;
  size_m: Vec3;
  yaw_deg: number;
}

const TURN_PER_S = 0.16; // radians
const RISE_S = 1.2; // In which a layer grows from the floor.
const CAMERA_M = 0.22;

export class LiveView {
  readonly node: HTMLElement;
  orbit: Orbit = { target: [0, 0, 0], azimuth: -2.2, elevation: 0.62, distance: 8, ortho: false };
  private readonly canvas = h("canvas", { class: "live-canvas" });
  private readonly marks = h("div", { class: "live-names", "aria-hidden": "true" });
  private readonly steps = h("ol", { class: "live-steps" });
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.PerspectiveCamera((FIELD * 180) / Math.PI, 1, 0.05, 500);
  private readonly layers = new Map<Layer, THREE.Object3D>();
  private readonly begun = new Map<Layer, number>();
  private readonly asked = new Set<Layer>();
  private readonly blocks = new BlocksView();
  private readonly controls: Controls;
  private readonly still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  private renderer: THREE.WebGLRenderer | null = null;
  private things: Thing[] = [];
  private frame = 0;
  private last = 0;
  private touched = false;

  constructor(private readonly job: string) {
    this.node = h("section", { class: "live", "aria-label": TEXT.start.live }, h("div", { class: "live-picture" }, this.canvas, this.marks), this.steps);
    this.node.hidden = true;
    this.controls = new Controls(this.canvas, this);
    this.canvas.addEventListener("pointerdown", () => (this.touched = true));
    this.scene.add(this.blocks.group);
    this.showSteps();
  }

  /** Fetch the layers that are new. Call it when a stage has ended. */
  async refresh(): Promise<void> {
    const ready = await getJson<Layer[]>(`api/start/jobs/${this.job}/layers`).catch(() => []);
    for (const layer of ready.filter((one) => !this.asked.has(one))) {
      this.asked.add(layer);
      const answer = await fetch(`api/start/jobs/${this.job}/layers/${layer}`).catch(() => null);
      if (answer?.ok) this.take(layer, await answer.arrayBuffer());
    }
  }

  pointAt(): null {
    return null;
  }

  dispose(): void {
    cancelAnimationFrame(this.frame);
    this.controls.dispose();
    this.renderer?.dispose();
    this.renderer = null;
  }

  private take(layer: Layer, data: ArrayBuffer): void {
    const made = layer === "blocks" ? this.takeBlocks(data) : this.takePacket(layer, Packet.read(data, "W2ML"));
    if (!made || !this.start()) return;
    if (layer !== "blocks") this.scene.add(made);
    this.layers.set(layer, made);
    this.begun.set(layer, performance.now());
    if (layer === "cells" || layer === "blocks") this.drop("points", "cameras");
    if (layer === "blocks") this.drop("cells", "things");
    if (!this.touched && layer !== "things" && layer !== "blocks") this.fit(made);
    this.node.hidden = false;
    this.showSteps();
  }

  private takePacket(layer: Layer, packet: Packet): THREE.Object3D | null {
    if (layer === "things") {
      this.things = (packet.told.things as Thing[]) ?? [];
      return boxesOf(this.things);
    }
    if (layer === "cameras") return frustaOf(packet.array("rays").values as Float32Array);
    const position = packet.array("position").values as Float32Array;
    const colour = packet.array("colour").values as Uint8Array;
    if (!position.length) return null;
    return layer === "points" ? pointsOf(position, colour) : cubesOf(position, colour, packet.told.voxel_m as number);
  }

  private takeBlocks(data: ArrayBuffer): THREE.Object3D {
    this.blocks.show(BlockMesh.read(data));
    this.blocks.group.visible = true;
    return this.blocks.group;
  }

  private drop(...layers: Layer[]): void {
    for (const layer of layers) this.layers.get(layer)?.removeFromParent();
  }

  private fit(made: THREE.Object3D): void {
    const box = new THREE.Box3().setFromObject(made);
    if (box.isEmpty()) return;
    this.orbit = fitted(this.orbit, box.min.toArray(), box.max.toArray(), this.camera.aspect);
  }

  private start(): boolean {
    if (this.renderer) return true;
    try {
      this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, antialias: true, alpha: true });
    } catch {
      return false; // Without WebGL the progress bar has to do.
    }
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace; // Colours are screen values.
    this.node.hidden = false;
    this.last = performance.now();
    const step = (now: number): void => {
      this.frame = requestAnimationFrame(step);
      this.draw(now);
    };
    this.frame = requestAnimationFrame(step);
    return true;
  }

  private draw(now: number): void {
    const { renderer } = this;
    const box = this.canvas.getBoundingClientRect();
    if (!renderer || !box.width) return;
    const passed = Math.min((now - this.last) / 1000, 0.1);
    this.last = now;
    if (!this.touched && !this.still) this.orbit = turned(this.orbit, TURN_PER_S * passed, 0);
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    renderer.setSize(box.width, box.height, false);
    this.camera.aspect = box.width / box.height;
    this.camera.updateProjectionMatrix();
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(...eyeOf(this.orbit));
    this.camera.lookAt(...this.orbit.target);
    for (const [layer, made] of this.layers) this.raise(layer, made, now);
    const { back } = axesOf(this.orbit);
    this.blocks.hide({ classes: 0, cuts: cutsFrom(back) | CEILING_CUT });
    renderer.render(this.scene, this.camera);
    this.placeNames(box);
  }

  /** A new layer grows out of the floor. The blocks have a transform of their own. */
  private raise(layer: Layer, made: THREE.Object3D, now: number): void {
    const share = this.still ? 1 : Math.min((now - this.begun.get(layer)!) / 1000 / RISE_S, 1);
    if (layer === "blocks" || layer === "cameras") return;
    made.scale.z = 1 - (1 - share) ** 3 + 1e-3;
  }

  private placeNames(box: DOMRect): void {
    const wanted = this.layers.has("things") && !this.layers.has("blocks") ? this.things : [];
    if (this.marks.childElementCount !== wanted.length) fill(this.marks, ...wanted.map((one) => h("span", {}, one.name)));
    for (const [at, thing] of wanted.entries()) {
      const [x, y, z] = thing.center_m;
      const place = new THREE.Vector3(x, y, z + thing.size_m[2] / 2).project(this.camera);
      const mark = this.marks.children[at] as HTMLElement;
      mark.style.transform = `translate(-50%, -100%) translate(${((place.x + 1) / 2) * box.width}px, ${((1 - place.y) / 2) * box.height}px)`;
    }
  }

  private showSteps(): void {
    const words = TEXT.start.layers;
    fill(this.steps, ...LAYERS.map((layer) => h("li", { class: this.layers.has(layer) ? "is-done" : "" }, words[layer])));
  }
}

function pointsOf(position: Float32Array, colour: Uint8Array): THREE.Points {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
  geometry.setAttribute("color", new THREE.BufferAttribute(colour, 3, true));
  return new THREE.Points(geometry, new THREE.PointsMaterial({ size: 0.09, vertexColors: true }));
}

function cubesOf(position: Float32Array, colour: Uint8Array, side: number): THREE.InstancedMesh {
  const count = position.length / 3;
  const made = new THREE.InstancedMesh(new THREE.BoxGeometry(side, side, side), new THREE.ShaderMaterial(SHADED), count);
  const matrix = new THREE.Matrix4();
  const shade = new THREE.Color();
  for (let n = 0; n < count; n++) {
    matrix.setPosition(position[3 * n]!, position[3 * n + 1]!, position[3 * n + 2]!);
    made.setMatrixAt(n, matrix);
    made.setColorAt(n, shade.setRGB(colour[3 * n]! / 255, colour[3 * n + 1]! / 255, colour[3 * n + 2]! / 255));
  }
  made.frustumCulled = false;
  return made;
}

/** Cubes whose sides differ in brightness, without lights. */
const SHADED: THREE.ShaderMaterialParameters = {
  vertexShader: /* glsl */ `
    varying vec3 shade;
    void main() {
      shade = instanceColor * (0.72 + 0.2 * abs(normal.z) + 0.08 * normal.x);
      gl_Position = projectionMatrix * modelViewMatrix * instanceMatrix * vec4(position, 1.0);
    }`,
  fragmentShader: /* glsl */ `
    varying vec3 shade;
    void main() {
      gl_FragColor = vec4(shade, 1.0);
    }`,
};

function frustaOf(rays: Float32Array): THREE.LineSegments {
  const places: number[] = [];
  for (let n = 0; n < rays.length; n += 6) {
    const from = new THREE.Vector3().fromArray(rays, n);
    const ahead = new THREE.Vector3().fromArray(rays, n + 3);
    const right = new THREE.Vector3().crossVectors(ahead, new THREE.Vector3(0, 0, 1)).normalize();
    const up = new THREE.Vector3().crossVectors(right, ahead);
    const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) =>
      from.clone().addScaledVector(ahead, CAMERA_M).addScaledVector(right, x! * 0.5 * CAMERA_M).addScaledVector(up, y! * 0.38 * CAMERA_M),
    );
    for (const [at, corner] of corners.entries()) {
      places.push(...from.toArray(), ...corner.toArray(), ...corner.toArray(), ...corners[(at + 1) % 4]!.toArray());
    }
  }
  return linesOf(places);
}

function boxesOf(things: readonly Thing[]): THREE.LineSegments {
  const places: number[] = [];
  for (const { center_m, size_m, yaw_deg } of things) {
    const edges = new THREE.EdgesGeometry(new THREE.BoxGeometry(...size_m));
    edges.rotateZ((yaw_deg * Math.PI) / 180).translate(...center_m);
    places.push(...edges.getAttribute("position").array);
  }
  return linesOf(places);
}

function linesOf(places: readonly number[]): THREE.LineSegments {
  const geometry = new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(places, 3));
  return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: new THREE.Color().setRGB(0.96, 0.6, 0.24) }));
}
