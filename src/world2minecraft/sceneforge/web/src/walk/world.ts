// The boxes that stop a player, as GET /api/collision sends them: a shape for each cell.

import type { Packet } from "../build/packet";
import type { Vec3 } from "../wire";
import type { Box } from "./body";
import type { World } from "./physics";

const TALLEST = 1; // cells by which a box may reach beyond its own: fences are 1.5 high

export class BoxWorld implements World {
  constructor(private readonly boxes: readonly Box[]) {}

  near(low: Vec3, high: Vec3): Box[] {
    return this.boxes.filter((box) => {
      for (let axis = 0; axis < 3; axis++) {
        if (box[axis as 0] >= high[axis as 0] || box[(axis + 3) as 3] <= low[axis as 0]) return false;
      }
      return true;
    });
  }
}

export class BlockWorld implements World {
  constructor(
    private readonly kinds: ArrayLike<number>, // [X, Y, Z] C order
    private readonly shape: Vec3,
    private readonly shapes: readonly (readonly Box[])[],
  ) {}

  static of(packet: Packet): BlockWorld {
    const { values: boxes } = packet.array("boxes");
    const { values: starts } = packet.array("starts");
    const { values: kinds, shape } = packet.array("kinds");
    const shapes = Array.from({ length: starts.length - 1 }, (_, kind) =>
      Array.from({ length: starts[kind + 1]! - starts[kind]! }, (_, at) => {
        const first = 6 * (starts[kind]! + at);
        return Array.from(boxes.slice(first, first + 6)) as unknown as Box;
      }),
    );
    return new BlockWorld(kinds, shape as Vec3, shapes);
  }

  near(low: Vec3, high: Vec3): Box[] {
    const [x0, y0, z0] = this.first(low);
    const [x1, y1, z1] = this.last(high);
    const found: Box[] = [];
    for (let x = x0; x < x1; x++) {
      for (let y = y0; y < y1; y++) {
        for (let z = z0; z < z1; z++) {
          const kind = this.kinds[(x * this.shape[1] + y) * this.shape[2] + z]!;
          if (!kind) continue;
          for (const b of this.shapes[kind]!) {
            found.push([b[0] + x, b[1] + y, b[2] + z, b[3] + x, b[4] + y, b[5] + z]);
          }
        }
      }
    }
    return found;
  }

  private first(low: Vec3): Vec3 {
    return low.map((value, axis) => this.within(Math.floor(value) - (axis === 1 ? TALLEST : 0), axis)) as Vec3;
  }

  private last(high: Vec3): Vec3 {
    return high.map((value, axis) => this.within(Math.floor(value) + 1, axis)) as Vec3;
  }

  private within(value: number, axis: number): number {
    return Math.min(Math.max(value, 0), this.shape[axis as 0]);
  }
}
