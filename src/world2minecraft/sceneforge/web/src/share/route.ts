// The way to a thing, which the planner has worked out for every place of the floor, and where
// someone on it is after some metres.

import type { Packet } from "../build/packet";
import type { Vec3 } from "../wire";

const NO_WAY = 65535;
const REACH = 6; // cells a body may stand off the floor's places

export interface Stand {
  place: Vec3;
  yawDeg: number; // the game's
}

export class Ways {
  private readonly feet: Float32Array;
  private readonly turns: Uint16Array;
  private readonly count: number;

  constructor(packet: Packet) {
    this.feet = packet.array("feet_of_ways").values as Float32Array;
    this.turns = packet.array("turns").values as Uint16Array;
    this.count = this.feet.length / 3;
  }

  /** The corners of the shortest way, in cells, from a place; null where there is none. */
  from(place: Vec3, way: number): Vec3[] | null {
    if (way < 0) return null;
    let here = this.nearest(place, way);
    if (here < 0) return null;
    const corners = [place, this.at(here)];
    for (let steps = 0; steps < this.count; steps++) {
      const next = this.turns[way * this.count + here]!;
      if (next === here) return corners;
      here = next;
      corners.push(this.at(here));
    }
    return null;
  }

  private nearest([x, y, z]: Vec3, way: number): number {
    let [best, least] = [-1, Infinity];
    for (let place = 0; place < this.count; place++) {
      if (this.turns[way * this.count + place] === NO_WAY) continue;
      const [a, b, c] = this.at(place);
      const away = Math.hypot(a - x, 2 * (b - y), c - z);
      if (away < least) [best, least] = [place, away];
    }
    return least <= REACH * 4 ? best : -1;
  }

  private at(place: number): Vec3 {
    const first = place * 3;
    return [this.feet[first]!, this.feet[first + 1]!, this.feet[first + 2]!];
  }
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

/** Turn towards a yaw by at most some degrees, the short way. */
export function turnedTo(yaw: number, wanted: number, most: number): number {
  const turn = ((((wanted - yaw + 180) % 360) + 360) % 360) - 180;
  return yaw + Math.min(Math.max(turn, -most), most);
}

function apart(a: Vec3, b: Vec3): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
