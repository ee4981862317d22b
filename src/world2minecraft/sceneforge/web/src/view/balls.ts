// A ball at the centre of each object, with an arrow head to its front.

import * as THREE from "three";

import type { Vec3 } from "../wire";
import { ballMaterial, flatMaterial } from "./plain";

export interface Ball {
  center: Vec3; // metres
  yaw: number; // radians
  radius: number;
  colour: Vec3; // 0..1
  edge: Vec3;
  chosen: boolean;
}

const CORNERS = [[-1, -1], [1, -1], [1, 1], [-1, 1]] as const;
const FAINT = 0.55; // size of a ball that something covers

/** An arrow head beside a ball, on the side that its front looks to. */
export function arrowCorners(center: Vec3, yaw: number, radius: number): Vec3[] {
  const at = (along: number, aside: number): Vec3 => [
    center[0] + along * Math.cos(yaw) - aside * Math.sin(yaw),
    center[1] + along * Math.sin(yaw) + aside * Math.cos(yaw),
    center[2],
  ];
  return [at(radius * 3.1, 0), at(radius * 1.35, radius * 0.95), at(radius * 1.35, -radius * 0.95)];
}

export class Balls {
  readonly group = new THREE.Group();
  private balls: readonly Ball[] = [];
  private covered = "";
  private readonly round = new THREE.Mesh(new THREE.BufferGeometry(), ballMaterial());
  private readonly arrows = new THREE.Mesh(
    new THREE.BufferGeometry(),
    flatMaterial("#ffffff", 1, { colours: true, side: THREE.DoubleSide, depthTest: false }),
  );

  constructor() {
    [this.arrows, this.round].forEach((mesh, order) => {
      mesh.frustumCulled = false;
      mesh.renderOrder = 2 + order;
      this.group.add(mesh);
    });
  }

  set(balls: readonly Ball[]): void {
    this.balls = balls;
    this.covered = "-";
    this.group.visible = balls.length > 0;
  }

  /** Draw those small, and without an arrow, whose centre is covered by something else. */
  dim(isCovered: (center: Vec3) => boolean): void {
    if (!this.balls.length) return;
    const faint = this.balls.map(({ center, chosen }) => !chosen && isCovered(center));
    const covered = faint.map(Number).join("");
    if (covered === this.covered) return;
    this.covered = covered;
    this.build(faint);
  }

  dispose(): void {
    for (const mesh of [this.round, this.arrows]) {
      mesh.geometry.dispose();
      mesh.material.dispose();
    }
  }

  private build(faint: readonly boolean[]): void {
    const round: Record<"position" | "ball" | "color" | "edge", number[]> = { position: [], ball: [], color: [], edge: [] };
    const arrows: { position: number[]; color: number[] } = { position: [], color: [] };
    const index: number[] = [];
    this.balls.forEach(({ center, yaw, radius, colour, edge, chosen }, i) => {
      for (const corner of CORNERS) {
        round.position.push(...center);
        round.ball.push(...corner, radius * (faint[i] ? FAINT : 1), chosen ? 0.42 : 0.2);
        round.color.push(...colour, 1);
        round.edge.push(...edge, 1);
      }
      index.push(...[0, 1, 2, 0, 2, 3].map((corner) => 4 * i + corner));
      if (faint[i]) return;
      for (const corner of arrowCorners(center, yaw, radius)) {
        arrows.position.push(...corner);
        arrows.color.push(...(chosen ? edge : colour), 1);
      }
    });
    fill(this.round, round);
    this.round.geometry.setIndex(index);
    fill(this.arrows, arrows);
  }
}

function fill(mesh: THREE.Mesh, parts: Record<string, number[]>): void {
  mesh.geometry.dispose();
  mesh.geometry = new THREE.BufferGeometry();
  for (const [name, values] of Object.entries(parts)) {
    mesh.geometry.setAttribute(name, new THREE.Float32BufferAttribute(values, name === "position" ? 3 : 4));
  }
}
