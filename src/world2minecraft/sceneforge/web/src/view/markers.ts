// Objects over the voxels: their centres, a box round each selected one, and the boxes of the
// furniture that stands for it.

import * as THREE from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";

import type { State } from "../store";
import { Balls, type Ball } from "./balls";
import { seenOf } from "./seen";
import type { Placed, SceneObject, Vec3 } from "../wire";

const RIM: Vec3 = [0.08, 0.09, 0.11];
const ACCENT: Record<State["theme"], Vec3> = { dark: [1, 1, 1], light: RIM };
const ALWAYS = { depthTest: false, depthWrite: false, transparent: true };

/** What of objects a mode shows. */
export function shownObjects({ objects, view, mode, scene }: Readonly<State>): SceneObject[] {
  if (!scene || (mode !== "inspect" && mode !== "objects")) return [];
  const { visible, low, high } = seenOf(view, scene.shape);
  return [...objects.values()].filter(({ class_id, center_m }) => {
    const cell = center_m.map((value, axis) => (value - scene.origin_m[axis]!) / scene.voxel_m);
    return visible[class_id] && cell.every((at, axis) => at >= low[axis]! && at <= high[axis]!);
  });
}

/** The twelve edges of a box that is turned about z, as pairs of points. */
export function boxEdges(center: Vec3, size: Vec3, yaw: number): number[] {
  const [cos, sin] = [Math.cos(yaw), Math.sin(yaw)];
  const corner = (index: number): Vec3 => {
    const [x, y, z] = size.map((side, axis) => (((index >> axis) & 1) - 0.5) * side) as Vec3;
    return [center[0] + x * cos - y * sin, center[1] + x * sin + y * cos, center[2] + z];
  };
  const edges: number[] = [];
  for (let index = 0; index < 8; index++) {
    for (const bit of [1, 2, 4]) {
      if (!(index & bit)) edges.push(...corner(index), ...corner(index | bit));
    }
  }
  return edges;
}

export class Markers {
  readonly group = new THREE.Group();
  private readonly outlines = new THREE.Group();
  private readonly balls = new Balls();
  private readonly lines: LineMaterial[] = [];

  constructor() {
    this.group.add(this.outlines, this.balls.group);
  }

  take(state: Readonly<State>): void {
    this.clear();
    const { scene, selectedObjects, theme, view } = state;
    if (!scene) return;
    const shown = shownObjects(state);
    const colourOf = (id: number) => (scene.classes[id]?.colour ?? [255, 255, 255]).map((c) => c / 255) as Vec3;
    if (state.mode === "objects") {
      for (const one of shown) this.boxes(one.placements, colourOf(one.class_id), selectedObjects.has(one.id));
    }
    const chosen = shown.filter(({ id }) => selectedObjects.has(id));
    const edges = chosen.flatMap((one) => boxEdges(one.center_m, one.size_m, radians(one.yaw_deg)));
    this.outline(edges, ACCENT[theme], 2, 0.95);
    this.balls.set(
      shown.map((one): Ball => {
        const edge = selectedObjects.has(one.id) ? ACCENT[theme] : RIM;
        const place = { center: one.center_m, yaw: radians(one.yaw_deg), radius: view.centerSize / 2 };
        return { ...place, colour: colourOf(one.class_id), edge, chosen: selectedObjects.has(one.id) };
      }),
    );
  }

  /** Lines are so many pixels wide whatever the size of the canvas. */
  resize(wide: number, tall: number): void {
    for (const line of this.lines) line.resolution.set(wide, tall);
  }

  dispose(): void {
    this.clear();
    this.balls.dispose();
  }

  /** Draw those small whose centre is covered by something else. */
  dim(isCovered: (center: Vec3) => boolean): void {
    this.balls.dim(isCovered);
  }

  private boxes(placements: readonly Placed[], colour: Vec3, chosen: boolean): void {
    const edges = placements.flatMap(({ center_m, size_m, quarter_turns }) =>
      boxEdges(center_m, size_m, (quarter_turns * Math.PI) / 2),
    );
    this.outline(edges, colour, chosen ? 2 : 1.25, chosen ? 0.9 : 0.55);
  }

  private outline(edges: number[], colour: Vec3, width: number, opacity: number): void {
    if (!edges.length) return;
    const material = new LineMaterial({ linewidth: width, opacity, ...ALWAYS });
    material.color.setRGB(...colour, THREE.SRGBColorSpace);
    this.lines.push(material);
    const lines = new LineSegments2(new LineSegmentsGeometry().setPositions(edges), material);
    lines.renderOrder = 1;
    lines.frustumCulled = false;
    this.outlines.add(lines);
  }

  private clear(): void {
    for (const child of [...this.outlines.children] as LineSegments2[]) {
      child.removeFromParent();
      child.geometry.dispose();
      child.material.dispose();
    }
    this.lines.length = 0;
  }
}

function radians(degrees: number): number {
  return (degrees * Math.PI) / 180;
}
