// Where someone on a way is after some length of it, and which way he looks.

import type { Vec3 } from "../wire";

export interface Stand {
  place: Vec3;
  yawDeg: number; // the game's
}

export class Route {
  readonly length: number; // cells
  private readonly ends: number[];

  constructor(readonly corners: readonly Vec3[]) {
    let gone = 0;
    this.ends = corners.map((corner, i) => (gone += i ? apart(corner, corners[i - 1]!) : 0));
    this.length = gone;
  }

  /** Where one is after a length, and where one looks. */
  at(gone: number): Stand {
    const ahead = this.ends.findIndex((end) => end >= gone);
    const i = ahead < 0 ? this.corners.length - 1 : Math.max(ahead, 1);
    const [from, to] = [this.corners[i - 1]!, this.corners[i] ?? this.corners[i - 1]!];
    const piece = apart(from, to);
    const share = piece ? Math.min(Math.max((gone - this.ends[i - 1]!) / piece, 0), 1) : 1;
    const place = from.map((v, axis) => v + (to[axis]! - v) * share) as Vec3;
    return { place, yawDeg: yawTo(from, to) };
  }

  /** Places along the way, one for each `every` cells. */
  crumbs(every: number): Vec3[] {
    return Array.from({ length: Math.floor(this.length / every) }, (_, i) => this.at((i + 0.5) * every).place);
  }
}

export function yawTo(from: Vec3, to: Vec3): number {
  return (Math.atan2(from[0] - to[0], to[2] - from[2]) * 180) / Math.PI;
}

function apart(a: Vec3, b: Vec3): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
