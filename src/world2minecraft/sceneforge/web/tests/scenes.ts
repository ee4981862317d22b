// Small scenes for the tests: random, but the same each time.

import type { Vec3 } from "../src/wire";

export function random(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

/** Labels with boxes of some classes in them, and single cells of noise. */
export function someScene(shape: Vec3, seed: number, noise = 0.05): Uint8Array {
  const next = random(seed);
  const [X, Y, Z] = shape;
  const labels = new Uint8Array(X * Y * Z);
  const below = (limit: number) => Math.floor(next() * limit);
  for (let box = 0; box < 5; box++) {
    const low = shape.map(below) as Vec3;
    const high = low.map((l, i) => l + 1 + below(shape[i]! - l)) as Vec3;
    const label = below(12);
    for (let x = low[0]; x < high[0]; x++)
      for (let y = low[1]; y < high[1]; y++)
        labels.fill(label, (x * Y + y) * Z + low[2], (x * Y + y) * Z + high[2]);
  }
  for (let i = 0; i < labels.length; i++) {
    if (next() < noise) labels[i] = next() < 0.3 ? 255 : below(12);
  }
  return labels;
}
