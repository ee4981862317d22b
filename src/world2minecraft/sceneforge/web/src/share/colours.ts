// The colour that a thing has in the picture, for the list: the mean of its textures, by area.

import type { BlockMesh } from "../build/mesh";
import type { Vec3 } from "../wire";

/** sRGB, 0..255, by the number of the thing. */
export function coloursOf(mesh: BlockMesh): Map<number, Vec3> {
  const layers = layerColours(mesh);
  const sums = new Map<number, [number, number, number, number]>();
  for (let quad = 0; quad < mesh.quads; quad++) {
    const id = mesh.instance[quad]!;
    if (!id) continue;
    const sum = sums.get(id) ?? [0, 0, 0, 0];
    const area = areaOf(mesh, quad);
    const texture = layers[mesh.kind[quad * 16]!] ?? [128, 128, 128];
    for (let i = 0; i < 3; i++) sum[i as 0] += (area * texture[i as 0] * mesh.colour[quad * 16 + i]!) / 255;
    sum[3] += area;
    sums.set(id, sum);
  }
  return new Map([...sums].map(([id, [r, g, b, area]]) => [id, [r, g, b].map((v) => Math.round(v / (area || 1))) as Vec3]));
}

function layerColours({ texels, layers }: BlockMesh): Vec3[] {
  const size = texels.length / Math.max(layers, 1);
  return Array.from({ length: layers }, (_, layer) => {
    const sum = [0, 0, 0, 0];
    for (let at = layer * size; at < (layer + 1) * size; at += 4) {
      if (texels[at + 3]! < 128) continue;
      for (let i = 0; i < 3; i++) sum[i]! += texels[at + i]!;
      sum[3]! += 1;
    }
    return sum.slice(0, 3).map((v) => v / (sum[3] || 1)) as Vec3;
  });
}

function areaOf({ position }: BlockMesh, quad: number): number {
  const side = (corner: number): number[] => [0, 1, 2].map((i) => position[quad * 12 + corner * 3 + i]! - position[quad * 12 + i]!);
  const [a, b] = [side(1), side(3)] as [number[], number[]];
  return Math.hypot(a[1]! * b[2]! - a[2]! * b[1]!, a[2]! * b[0]! - a[0]! * b[2]!, a[0]! * b[1]! - a[1]! * b[0]!);
}
