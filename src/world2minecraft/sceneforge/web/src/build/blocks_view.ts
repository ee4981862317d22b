// The blocks in the picture: a mesh in the view's scene, outlines of what is selected, picking.

import * as THREE from "three";

import type { Vec3 } from "../wire";
import { BlockMaterial } from "./material";
import type { BlockMesh, DrawnFacts, Hidden, Met } from "./mesh";

const OUTLINE = { object: 0xffd23f, block: 0x000000 };
const GROWN = 0.004; // cells: outlines lie just outside what they are around

const SIZE = new THREE.Vector2();

export class BlocksView<Facts extends DrawnFacts = DrawnFacts> {
  readonly group = new THREE.Group();
  readonly material = new BlockMaterial();
  hidden: Hidden = { classes: 0, cuts: 0 };
  mesh: BlockMesh<Facts> | null = null;
  private drawn: THREE.Mesh | null = null;
  private readonly outlines = new Map<string, THREE.LineSegments>();
  private toGrid = new THREE.Matrix4();

  constructor() {
    this.group.matrixAutoUpdate = false;
    this.group.visible = false;
  }

  show(mesh: BlockMesh<Facts>): void {
    this.mesh = mesh;
    this.group.matrix.fromArray(mesh.facts.grid_to_room).transpose();
    this.group.updateMatrixWorld(true);
    this.toGrid = this.group.matrix.clone().invert();
    this.material.setTextures(mesh.texels, mesh.facts.texture_px, mesh.layers);
    this.drawn?.geometry.dispose();
    this.drawn?.removeFromParent();
    this.drawn = new THREE.Mesh(geometryOf(mesh), [this.material.solid, this.material.clear]);
    this.drawn.frustumCulled = false;
    this.drawn.geometry.boundingSphere = new THREE.Sphere(); // Not asked for, and slow to work out.
    this.drawn.onBeforeRender = (renderer) => {
      this.material.uniforms.tall.value = renderer.getDrawingBufferSize(SIZE).y;
    };
    this.group.add(this.drawn);
  }

  hide(hidden: Hidden): void {
    this.hidden = hidden;
    this.material.uniforms.hiddenClasses.value = hidden.classes;
    this.material.uniforms.hiddenCuts.value = hidden.cuts;
  }

  /** What a ray in room metres meets; `t` counts in lengths of the ray. */
  meet(from: Vec3, direction: Vec3): Met | null {
    const start = new THREE.Vector3(...from).applyMatrix4(this.toGrid);
    const end = new THREE.Vector3(...from).add(new THREE.Vector3(...direction)).applyMatrix4(this.toGrid);
    return this.mesh?.meet(start.toArray(), end.sub(start).toArray(), this.hidden) ?? null;
  }

  /** Room metres of a point in cells of the build. */
  toRoom(point: Vec3): Vec3 {
    return new THREE.Vector3(...point).applyMatrix4(this.group.matrix).toArray();
  }

  /** Draw boxes, in cells, under a name; none removes what was there. */
  outline(name: "object" | "block", boxes: readonly { low: Vec3; high: Vec3 }[]): void {
    const old = this.outlines.get(name);
    old?.geometry.dispose();
    old?.removeFromParent();
    const lines = new THREE.LineSegments(
      new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(boxes.flatMap(edges), 3)),
      new THREE.LineBasicMaterial({ color: OUTLINE[name] }),
    );
    lines.frustumCulled = false;
    this.outlines.set(name, lines);
    this.group.add(lines);
  }
}

function geometryOf(mesh: BlockMesh): THREE.BufferGeometry {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(mesh.position, 3));
  geometry.setAttribute("uv", new THREE.BufferAttribute(mesh.uv, 2));
  geometry.setAttribute("light", new THREE.BufferAttribute(mesh.light, 4, true));
  geometry.setAttribute("colour", new THREE.BufferAttribute(mesh.colour, 4, true));
  geometry.setAttribute("kind", new THREE.BufferAttribute(mesh.kind, 4));
  geometry.setAttribute("outward", new THREE.BufferAttribute(outward(mesh), 4, true));
  const index = new Uint32Array(mesh.quads * 6);
  for (let quad = 0; quad < mesh.quads; quad++) {
    const [first, a, b, c] = corners(mesh, quad);
    index.set([first, a, b, first, b, c], quad * 6);
  }
  geometry.setIndex(new THREE.BufferAttribute(index, 1));
  const solid = mesh.facts.clear_from * 6;
  geometry.addGroup(0, solid, 0);
  geometry.addGroup(solid, index.length - solid, 1);
  return geometry;
}

/**
 * Where each corner is pushed so that its quad grows, as signed bytes: by a tenth of a pixel in the
 * shader. Where a long edge meets the ends of short ones, rounding would else leave pixels through
 * which the background shines.
 */
function outward({ position, quads, facts }: BlockMesh): Int8Array {
  const ways = new Int8Array(quads * 16);
  for (let quad = 0; quad < facts.clear_from; quad++) {
    const edge = (a: number, b: number): Vec3 => {
      const side = [0, 1, 2].map((i) => position[quad * 12 + b * 3 + i]! - position[quad * 12 + a * 3 + i]!);
      const length = Math.hypot(...side) || 1;
      return side.map((v) => (v / length) * 63) as Vec3; // Two of them still fit into a byte.
    };
    const one = edge(0, 1);
    const two = edge(0, 3);
    for (let i = 0; i < 3; i++) {
      const [a, b] = [one[i as 0], two[i as 0]];
      ways.set([-a - b], quad * 16 + i);
      ways.set([a - b], quad * 16 + 4 + i);
      ways.set([a + b], quad * 16 + 8 + i);
      ways.set([b - a], quad * 16 + 12 + i);
    }
  }
  return ways;
}

/** Split a quad along the diagonal whose ends are more alike in light, so that corners look round. */
function corners({ light }: BlockMesh, quad: number): [number, number, number, number] {
  const at = quad * 4;
  const dark = (corner: number): number => light[(at + corner) * 4 + 2]!;
  const turned = dark(0) + dark(2) > dark(1) + dark(3);
  return turned ? [at + 1, at + 2, at + 3, at] : [at, at + 1, at + 2, at + 3];
}

function edges({ low, high }: { low: Vec3; high: Vec3 }): number[] {
  const box = [low.map((v) => v - GROWN), high.map((v) => v + GROWN)];
  const lines: number[] = [];
  for (let axis = 0; axis < 3; axis++) {
    for (let corner = 0; corner < 4; corner++) {
      const point = (end: number): number[] =>
        [0, 1, 2].map((i) => {
          const other = i === (axis + 1) % 3 ? corner & 1 : corner >> 1;
          return box[i === axis ? end : other]![i]!;
        });
      lines.push(...point(0), ...point(1));
    }
  }
  return lines;
}
