// The mesh of a build, as GET /api/build sends it (block_preview.py), and what a ray meets in it.

import type { Vec3 } from "../wire";
import { Packet } from "./packet";

export const CEILING_CUT = 1 << 4;
export const PARTITION_CUT = 1 << 5;
const NO_COVER = 65535;

/** Bits of what is not drawn: classes by the legend, cuts that open a room. */
export interface Hidden {
  classes: number;
  cuts: number;
}

export interface Met {
  quad: number;
  t: number;
  cell: Vec3; // of the build
}

/** What drawing needs to know. */
export interface DrawnFacts {
  clear_from: number; // the first quad that is drawn over what is behind it
  texture_px: number;
  grid_to_room: number[]; // 4 x 4, row by row
}

export interface BuildFacts extends DrawnFacts {
  rev: number;
  blocks_per_metre: number;
  style: string;
  palette: string[];
  blocks: number;
  feet: Vec3;
  yaw_deg: number;
}

export interface MeshArrays {
  position: Float32Array; // four corners a quad, in cells of the build
  uv: Float32Array;
  light: Uint8Array;
  colour: Uint8Array;
  kind: Uint16Array; // texture; class + 256 * cuts, its own and of what lies on it; 0
  state: Uint16Array; // by quad
  instance: Uint16Array; // by quad
  texels: Uint8Array;
}

export class BlockMesh<Facts extends DrawnFacts = DrawnFacts> implements MeshArrays {
  readonly position: Float32Array;
  readonly uv: Float32Array;
  readonly light: Uint8Array;
  readonly colour: Uint8Array;
  readonly kind: Uint16Array;
  readonly state: Uint16Array;
  readonly instance: Uint16Array;
  readonly texels: Uint8Array;

  constructor(
    readonly facts: Facts,
    arrays: MeshArrays,
    readonly layers: number,
  ) {
    this.position = arrays.position;
    this.uv = arrays.uv;
    this.light = arrays.light;
    this.colour = arrays.colour;
    this.kind = arrays.kind;
    this.state = arrays.state;
    this.instance = arrays.instance;
    this.texels = arrays.texels;
  }

  static read(data: ArrayBuffer): BlockMesh<BuildFacts> {
    const packet = Packet.read(data, "W2MB");
    const take = <T>(name: string): T => packet.array(name).values as T;
    const arrays = {
      position: take<Float32Array>("position"),
      uv: take<Float32Array>("uv"),
      light: take<Uint8Array>("light"),
      colour: take<Uint8Array>("colour"),
      kind: take<Uint16Array>("kind"),
      state: take<Uint16Array>("state"),
      instance: take<Uint16Array>("instance"),
      texels: take<Uint8Array>("texels"),
    };
    return new BlockMesh(packet.told as unknown as BuildFacts, arrays, packet.array("texels").shape[0] ?? 0);
  }

  get quads(): number {
    return this.state.length;
  }

  isHidden(quad: number, hidden: Hidden): boolean {
    const cover = this.kind[quad * 16 + 2]!;
    return isOff(this.kind[quad * 16 + 1]!, hidden) || (cover !== NO_COVER && !isOff(cover, hidden));
  }

  /** The first quad that a ray, in cells of the build, meets from its front. */
  meet(from: Vec3, ray: Vec3, hidden: Hidden): Met | null {
    let best = -1;
    let nearest = Infinity;
    for (let quad = 0; quad < this.quads; quad++) {
      const t = this.distance(quad, from, ray);
      if (t < nearest && !this.isHidden(quad, hidden)) [best, nearest] = [quad, t];
    }
    return best < 0 ? null : { quad: best, t: nearest, cell: this.cellAt(best, from, ray, nearest) };
  }

  /** The box of all quads of an object, in cells of the build; null where it has none. */
  boxOf(id: number): { low: Vec3; high: Vec3 } | null {
    const low: Vec3 = [Infinity, Infinity, Infinity];
    const high: Vec3 = [-Infinity, -Infinity, -Infinity];
    for (let quad = 0; quad < this.quads; quad++) {
      if (this.instance[quad] !== id) continue;
      for (let at = quad * 12; at < quad * 12 + 12; at++) {
        const axis = (at % 3) as 0 | 1 | 2;
        low[axis] = Math.min(low[axis], this.position[at]!);
        high[axis] = Math.max(high[axis], this.position[at]!);
      }
    }
    return low[0] <= high[0] ? { low, high } : null;
  }

  /** Where along a ray a quad is met from its front; Infinity where it is not. */
  private distance(quad: number, from: Vec3, ray: Vec3): number {
    const p = this.position;
    const o = quad * 12;
    const ax = p[o + 3]! - p[o]!, ay = p[o + 4]! - p[o + 1]!, az = p[o + 5]! - p[o + 2]!; // prettier-ignore
    const bx = p[o + 9]! - p[o]!, by = p[o + 10]! - p[o + 1]!, bz = p[o + 11]! - p[o + 2]!; // prettier-ignore
    const nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx; // prettier-ignore
    const steep = nx * ray[0] + ny * ray[1] + nz * ray[2];
    if (steep >= 0) return Infinity;
    const fx = from[0] - p[o]!, fy = from[1] - p[o + 1]!, fz = from[2] - p[o + 2]!; // prettier-ignore
    const t = -(nx * fx + ny * fy + nz * fz) / steep;
    if (t <= 0) return Infinity;
    const x = fx + t * ray[0], y = fy + t * ray[1], z = fz + t * ray[2]; // prettier-ignore
    const a = (x * ax + y * ay + z * az) / (ax * ax + ay * ay + az * az);
    const b = (x * bx + y * by + z * bz) / (bx * bx + by * by + bz * bz);
    return a >= 0 && a <= 1 && b >= 0 && b <= 1 ? t : Infinity;
  }

  private cellAt(quad: number, from: Vec3, ray: Vec3, t: number): Vec3 {
    const inward = this.inward(quad);
    return from.map((v, i) => Math.floor(v + t * ray[i as 0] + inward[i as 0] * 0.01)) as Vec3;
  }

  private inward(quad: number): Vec3 {
    const at = (corner: number): Vec3 => {
      const o = quad * 12 + corner * 3;
      return [this.position[o]!, this.position[o + 1]!, this.position[o + 2]!];
    };
    const [c, a, b] = [at(0), at(1), at(3)];
    const u = a.map((v, i) => v - c[i as 0]) as Vec3;
    const w = b.map((v, i) => v - c[i as 0]) as Vec3;
    const n: Vec3 = [w[1] * u[2] - w[2] * u[1], w[2] * u[0] - w[0] * u[2], w[0] * u[1] - w[1] * u[0]];
    const length = Math.hypot(...n) || 1;
    return n.map((v) => v / length) as Vec3;
  }
}

function isOff(facts: number, { classes, cuts }: Hidden): boolean {
  return ((1 << (facts & 255)) & classes) !== 0 || ((facts >> 8) & cuts) !== 0;
}

/** Which cuts open the room to one who looks from this side: bits of render/mesh/cuts.py. */
export function cutsFrom(back: Vec3): number {
  const [x, z] = [back[0], -back[1]]; // Room -y is block z.
  const corner = (x > 0 ? 2 : 0) + (z > 0 ? 1 : 0);
  return (1 << corner) | PARTITION_CUT;
}
