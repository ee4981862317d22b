// Where drawn cells are, as a texture that is a cell wider on each side: contact shadows read it.

import * as THREE from "three";

import type { Volume } from "./volume";
import type { Vec3 } from "../wire";

const LARGEST = 2046; // Larger volumes are drawn without shadows.

export function solidTexture({ labels, shape }: Volume, visible: ArrayLike<boolean>): THREE.Data3DTexture | null {
  if (Math.max(...shape) > LARGEST) return null;
  const [X, Y, Z] = shape.map((side) => side + 2) as Vec3;
  const value = Uint8Array.from({ length: 256 }, (_, label) => (visible[label] ? 255 : 0));
  const data = new Uint8Array(X * Y * Z);
  let from = 0;
  for (let x = 1; x < X - 1; x++)
    for (let y = 1; y < Y - 1; y++) {
      const to = (x * Y + y) * Z + 1;
      for (let z = 0; z < Z - 2; z++) data[to + z] = value[labels[from++]!]!;
    }
  const texture = new THREE.Data3DTexture(data, Z, Y, X);
  texture.format = THREE.RedFormat;
  texture.minFilter = texture.magFilter = THREE.LinearFilter;
  texture.unpackAlignment = 1;
  texture.needsUpdate = true;
  return texture;
}
