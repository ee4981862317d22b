// The way to a thing, which the planner has worked out for every place of the floor.

import type { Packet } from "../build/packet";
import type { Vec3 } from "../wire";

const NO_WAY = 65535;
const REACH = 6; // cells a body may stand off the floor's places

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
