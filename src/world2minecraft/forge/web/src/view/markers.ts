// Objects over the voxels: a ball at each centre with an arrow to its front, a box round each
// selected one, and the boxes of the furniture that stands for it.

import * as THREE from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";

import type { State } from "../store";
import { seenOf } from "./seen";
import type { Placed, SceneObject, Vec3 } from "../wire";

const ACCENT = { dark: 0xffffff, light: 0x14171c };
const RIM = 0x14171c;
const ALWAYS = { depthTest: false, depthWrite: false, transparent: true };

interface Ball {
  center: Vec3;
  radius: number;
  colour: THREE.Color;
  edge: THREE.Color;
  chosen: boolean;
}

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

/** An arrow head on the floor plane of a ball, beyond it on the side that its front looks to. */
export function arrowCorners(center: Vec3, yaw: number, radius: number): Vec3[] {
  const at = (along: number, aside: number): Vec3 => [
    center[0] + along * Math.cos(yaw) - aside * Math.sin(yaw),
    center[1] + along * Math.sin(yaw) + aside * Math.cos(yaw),
    center[2],
  ];
  return [at(radius * 3.1, 0), at(radius * 1.35, radius * 0.95), at(radius * 1.35, -radius * 0.95)];
}

export class Markers {
  readonly group = new THREE.Group();
  private readonly ball = new THREE.SphereGeometry(1, 20, 14);
  private readonly lines: LineMaterial[] = [];
  private shown: Ball[] = [];
  private parts: { ball: THREE.InstancedMesh; rim: THREE.InstancedMesh; arrow: THREE.Mesh } | null = null;

  take(state: Readonly<State>): void {
    this.clear();
    const { scene, selectedObjects, theme } = state;
    if (!scene) return;
    const shown = shownObjects(state);
    const colourOf = (id: number) => new THREE.Color().setRGB(
      ...(scene.classes[id]?.colour.map((c) => c / 255) as Vec3), THREE.SRGBColorSpace);
    const chosen = shown.filter(({ id }) => selectedObjects.has(id));
    if (state.mode === "objects") {
      for (const one of shown) this.boxes(one.placements, colourOf(one.class_id), selectedObjects.has(one.id));
    }
    const edges = chosen.flatMap((one) => boxEdges(one.center_m, one.size_m, (one.yaw_deg * Math.PI) / 180));
    this.outline(edges, new THREE.Color(ACCENT[theme]), 2, 0.95);
    this.balls(shown, state, colourOf);
  }

  /** Lines are so many pixels wide whatever the size of the canvas. */
  resize(wide: number, tall: number): void {
    for (const line of this.lines) line.resolution.set(wide, tall);
  }

  dispose(): void {
    this.clear();
    this.ball.dispose();
  }

  /** Draw those small and faint whose centre is covered by something else. */
  dim(isCovered: (center: Vec3) => boolean): void {
    const { ball, rim, arrow } = this.parts ?? {};
    if (!ball || !rim || !arrow) return;
    const colours = arrow.geometry.getAttribute("color");
    this.shown.forEach(({ center, radius, colour, edge, chosen }, i) => {
      const faint = !chosen && isCovered(center);
      const size = faint ? radius * 0.55 : radius;
      const at = new THREE.Matrix4().makeTranslation(...center);
      ball.setMatrixAt(i, at.clone().scale(new THREE.Vector3().setScalar(size)));
      rim.setMatrixAt(i, at.scale(new THREE.Vector3().setScalar(size * (chosen ? 1.42 : 1.22))));
      ball.setColorAt(i, colour);
      rim.setColorAt(i, edge);
      const alpha = faint ? 0 : 1;
      for (let corner = 0; corner < 3; corner++) {
        colours.setXYZW(3 * i + corner, ...((chosen ? edge : colour).toArray() as Vec3), alpha);
      }
    });
    for (const mesh of [ball, rim]) {
      mesh.instanceMatrix.needsUpdate = true;
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    }
    colours.needsUpdate = true;
  }

  private balls(shown: SceneObject[], state: Readonly<State>, colourOf: (id: number) => THREE.Color): void {
    this.parts = null;
    if (!shown.length) return;
    const radius = state.view.centerSize / 2;
    this.shown = shown.map(({ id, center_m, class_id }) => {
      const chosen = state.selectedObjects.has(id);
      const edge = new THREE.Color(chosen ? ACCENT[state.theme] : RIM);
      return { center: center_m, radius, colour: colourOf(class_id), edge, chosen };
    });
    const corners = shown.flatMap((one) => arrowCorners(one.center_m, (one.yaw_deg * Math.PI) / 180, radius));
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(corners.flat(), 3));
    geometry.setAttribute("color", new THREE.Float32BufferAttribute(new Float32Array(corners.length * 4), 4));
    const material = new THREE.MeshBasicMaterial({ vertexColors: true, side: THREE.DoubleSide, ...ALWAYS });
    const arrow = new THREE.Mesh(geometry, material);
    arrow.renderOrder = 2;
    arrow.frustumCulled = false;
    this.group.add(arrow);
    this.parts = { ball: this.instanced(shown.length, 3), rim: this.instanced(shown.length, 2), arrow };
  }

  private instanced(count: number, order: number): THREE.InstancedMesh {
    const mesh = new THREE.InstancedMesh(this.ball, new THREE.MeshBasicMaterial(ALWAYS), count);
    mesh.renderOrder = order;
    mesh.frustumCulled = false;
    this.group.add(mesh);
    return mesh;
  }

  private boxes(placements: readonly Placed[], colour: THREE.Color, chosen: boolean): void {
    const edges = placements.flatMap(({ center_m, size_m, quarter_turns }) =>
      boxEdges(center_m, size_m, (quarter_turns * Math.PI) / 2),
    );
    this.outline(edges, colour, chosen ? 2 : 1.25, chosen ? 0.9 : 0.55);
  }

  private outline(edges: number[], colour: THREE.Color, width: number, opacity: number): void {
    if (!edges.length) return;
    const material = new LineMaterial({ color: colour.getHex(), linewidth: width, opacity, ...ALWAYS });
    this.lines.push(material);
    const lines = new LineSegments2(new LineSegmentsGeometry().setPositions(edges), material);
    lines.renderOrder = 1;
    lines.frustumCulled = false;
    this.group.add(lines);
  }

  private clear(): void {
    for (const child of [...this.group.children]) {
      const mesh = child as THREE.Mesh;
      child.removeFromParent();
      if (mesh.geometry !== this.ball) mesh.geometry.dispose();
      (mesh.material as THREE.Material).dispose();
      if (mesh instanceof THREE.InstancedMesh) mesh.dispose();
    }
    this.lines.length = 0;
    this.parts = null;
  }
}
