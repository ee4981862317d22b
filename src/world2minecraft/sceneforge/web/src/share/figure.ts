// Someone who walks through the room before one's eyes, and the crumbs of the way ahead. All in cells.

import * as THREE from "three";

import type { Vec3 } from "../wire";
import type { Stand } from "../walk/route";

// Parts of a figure of height 1: middle and size along x, y, z, and colour.
const PARTS: readonly { name: string; middle: Vec3; size: Vec3; colour: number }[] = [
  { name: "left leg", middle: [-0.07, 0.19, 0], size: [0.125, 0.38, 0.13], colour: 0x3b4a6b },
  { name: "right leg", middle: [0.07, 0.19, 0], size: [0.125, 0.38, 0.13], colour: 0x3b4a6b },
  { name: "left arm", middle: [-0.19, 0.565, 0], size: [0.1, 0.37, 0.12], colour: 0xd9792b },
  { name: "right arm", middle: [0.19, 0.565, 0], size: [0.1, 0.37, 0.12], colour: 0xd9792b },
  { name: "body", middle: [0, 0.565, 0], size: [0.28, 0.37, 0.15], colour: 0xf59a3c },
  { name: "head", middle: [0, 0.875, 0], size: [0.24, 0.25, 0.24], colour: 0xe8b98f },
  { name: "hair", middle: [0, 0.97, -0.01], size: [0.26, 0.07, 0.26], colour: 0x4a3426 },
];
const SHADES = [0.82, 0.82, 1, 0.6, 0.92, 0.92]; // of the faces +x -x +y -y +z -z
const SWING = 0.6; // radians
const STRIDE = 0.75; // of the height, for both legs
const CRUMB = { size: 0.055, colour: 0xff8a1f }; // of the height
const MOST_CRUMBS = 400;

export class Figure {
  readonly group = new THREE.Group();
  private readonly body = new THREE.Group();
  private readonly limbs = new Map<string, THREE.Object3D>();
  private readonly crumbs: THREE.InstancedMesh;
  private ahead: readonly Vec3[] = [];
  private readonly tints: { material: THREE.MeshBasicMaterial; colour: THREE.Color }[] = [];

  /** A figure of a height in cells. */
  constructor(readonly height: number) {
    for (const part of PARTS) this.add(part);
    this.body.scale.setScalar(height);
    const side = CRUMB.size * height;
    this.crumbs = new THREE.InstancedMesh(new THREE.BoxGeometry(side, side / 4, side), this.paint(CRUMB.colour), MOST_CRUMBS);
    this.crumbs.count = 0;
    this.crumbs.frustumCulled = false;
    this.group.add(this.body, this.crumbs);
  }

  /** Whether the figure itself is drawn: not while one looks out of its eyes. */
  set isSeen(on: boolean) {
    this.body.visible = on;
  }

  /** By night it is darker. */
  dim(share: number): void {
    for (const { material, colour } of this.tints) material.color.copy(colour).multiplyScalar(share);
  }

  stand({ place, yawDeg }: Stand, gone = 0): void {
    this.body.position.set(...place);
    this.body.rotation.y = (-yawDeg * Math.PI) / 180;
    const phase = Math.sin((gone / (STRIDE * this.height)) * Math.PI * 2) * (gone ? SWING : 0);
    for (const [name, limb] of this.limbs) limb.rotation.x = name.startsWith("left") === name.endsWith("leg") ? phase : -phase;
  }

  lay(crumbs: readonly Vec3[]): void {
    this.ahead = crumbs.slice(0, MOST_CRUMBS);
    const matrix = new THREE.Matrix4();
    this.ahead.forEach(([x, y, z], i) => {
      this.crumbs.setMatrixAt(i, matrix.makeTranslation(x, y + 0.02 * this.height, z));
    });
    this.crumbs.instanceMatrix.needsUpdate = true;
    this.crumbs.count = this.ahead.length;
  }

  private add({ name, middle, size, colour }: (typeof PARTS)[number]): void {
    const materials = SHADES.map((shade) => this.paint(new THREE.Color(colour).multiplyScalar(shade).getHex()));
    const geometry = new THREE.BoxGeometry(...size);
    const mesh = new THREE.Mesh(geometry, materials);
    const hinge = new THREE.Group(); // at the upper end: limbs swing
    const swings = name.includes(" ");
    hinge.position.set(middle[0], middle[1] + (swings ? size[1] / 2 : 0), middle[2]);
    mesh.position.y = swings ? -size[1] / 2 : 0;
    hinge.add(mesh);
    this.body.add(hinge);
    if (swings) this.limbs.set(name, hinge);
  }

  private paint(colour: number): THREE.MeshBasicMaterial {
    const material = new THREE.MeshBasicMaterial({ color: colour });
    this.tints.push({ material, colour: material.color.clone() });
    return material;
  }
}
