// Objects over the voxels: a ball at each centre with an arrow to its front, a box round each
// selected one, and the boxes of the furniture that stands for it.

import * as THREE from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";

import type { State } from "../store";
import type { Placed, SceneObject, Vec3 } from "../wire";

const ACCENT = { dark: 0xffffff, light: 0x14171c };
const ALWAYS = { depthTest: false, depthWrite: false, transparent: true };

/** What of objects a mode shows. */
export function shownObjects({ objects, view, mode }: Readonly<State>): SceneObject[] {
  if (mode !== "inspect" && mode !== "objects") return [];
  const hidden = (id: number) => (view.solo === null ? view.hidden.has(id) : id !== view.solo);
  return [...objects.values()].filter(({ class_id }) => !hidden(class_id));
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

  private balls(shown: SceneObject[], state: Readonly<State>, colourOf: (id: number) => THREE.Color): void {
    if (!shown.length) return;
    const radius = state.view.centerSize / 2;
    const rim = new THREE.Color(ACCENT[state.theme]);
    const inner = this.instanced(shown.length, 3);
    const outer = this.instanced(shown.length, 2);
    const arrows: number[] = [];
    const tints: number[] = [];
    shown.forEach(({ id, center_m, class_id, yaw_deg }, i) => {
      const chosen = state.selectedObjects.has(id);
      const matrix = new THREE.Matrix4().makeTranslation(...center_m);
      inner.setMatrixAt(i, matrix.clone().scale(new THREE.Vector3().setScalar(radius)));
      outer.setMatrixAt(i, matrix.scale(new THREE.Vector3().setScalar(radius * (chosen ? 1.42 : 1.2))));
      inner.setColorAt(i, colourOf(class_id));
      outer.setColorAt(i, chosen ? rim : new THREE.Color(0x14171c));
      for (const corner of arrowCorners(center_m, (yaw_deg * Math.PI) / 180, radius)) {
        arrows.push(...corner);
        tints.push(...(chosen ? rim : colourOf(class_id)).toArray());
      }
    });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(arrows, 3));
    geometry.setAttribute("color", new THREE.Float32BufferAttribute(tints, 3));
    const material = new THREE.MeshBasicMaterial({ vertexColors: true, side: THREE.DoubleSide, ...ALWAYS });
    const heads = new THREE.Mesh(geometry, material);
    heads.renderOrder = 2;
    heads.frustumCulled = false;
    this.group.add(heads);
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
  }
}
