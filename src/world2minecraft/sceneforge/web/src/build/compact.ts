// The mesh of a build as compact_mesh_arrays (rendering/mesh) packs it, restored: three corners of
// each quad as planes of bytes, a column per quad.

import { BlockMesh, type DrawnFacts } from "./mesh";
import type { Packet } from "./packet";

export function expanded(packet: Packet): BlockMesh {
  const facts = packet.told as unknown as DrawnFacts & { unit: number };
  const lights = packet.array("lights");
  const kinds = packet.array("kinds_of_quads").values as Uint16Array;
  const colours = packet.array("colours").values as Uint8Array;
  const texels = packet.array("texels");
  const count = lights.shape[1] ?? 0;
  const arrays = {
    position: corners(packet.array("corners").values as Uint8Array, 3, count, facts.unit),
    uv: corners(packet.array("uvs").values as Uint8Array, 2, count, facts.unit),
    light: lightsOf(lights.values as Uint8Array, count),
    colour: new Uint8Array(count * 16),
    kind: new Uint16Array(count * 16),
    state: new Uint16Array(count),
    instance: kinds.slice(3 * count),
    texels: texels.values as Uint8Array,
  };
  for (let quad = 0; quad < count; quad++) {
    for (let corner = quad * 16; corner < quad * 16 + 16; corner += 4) {
      for (let i = 0; i < 4; i++) arrays.colour[corner + i] = colours[i * count + quad]!;
      for (let i = 0; i < 3; i++) arrays.kind[corner + i] = kinds[i * count + quad]!;
    }
  }
  return new BlockMesh(facts, arrays, texels.shape[0] ?? 0);
}

/** Four corners a quad from one and two edges: numbers of 32 bits in four planes [3 * wide, Q]. */
function corners(planes: Uint8Array, wide: number, count: number, unit: number): Float32Array {
  const plane = planes.length / 4;
  const at = (row: number, quad: number): number => {
    const i = row * count + quad;
    const bits = planes[i]! | (planes[plane + i]! << 8) | (planes[2 * plane + i]! << 16) | (planes[3 * plane + i]! << 24);
    return bits / unit;
  };
  const found = new Float32Array(count * 4 * wide);
  for (let quad = 0; quad < count; quad++) {
    for (let axis = 0; axis < wide; axis++) {
      const [first, one, two] = [at(axis, quad), at(wide + axis, quad), at(2 * wide + axis, quad)];
      const o = quad * 4 * wide + axis;
      found[o] = first;
      found[o + wide] = first + one;
      found[o + 2 * wide] = first + one + two;
      found[o + 3 * wide] = first + two;
    }
  }
  return found;
}

/** Sky, block and corner by corner, then the quad's own: rows of columns. */
function lightsOf(rows: Uint8Array, count: number): Uint8Array {
  const found = new Uint8Array(count * 16);
  for (let quad = 0; quad < count; quad++) {
    for (let corner = 0; corner < 4; corner++) {
      const o = quad * 16 + corner * 4;
      for (let i = 0; i < 3; i++) found[o + i] = rows[(corner * 3 + i) * count + quad]!;
      found[o + 3] = rows[12 * count + quad]!;
    }
  }
  return found;
}
