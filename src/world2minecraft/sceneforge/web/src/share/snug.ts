// The nearest place from which points fit into a picture with margins, looking one way.

import { axesOf, FIELD, plus, type Orbit } from "../view/camera";
import type { Vec3 } from "../wire";

/** Shares of the picture, from its edges, that stay free. */
export interface Margins {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

/**
 * An orbit that looks the same way and has all points in view. Coordinates across and up bound the
 * distance on both sides; where the bounds of both are equal, it is the least.
 */
export function snug(orbit: Orbit, points: Float32Array, aspect: number, margins: Margins): Orbit {
  if (!points.length) return orbit;
  const { back, right, up } = axesOf(orbit);
  const tan = Math.tan(FIELD / 2);
  const [r, l] = [1 - 2 * margins.right, 1 - 2 * margins.left].map((v) => v * tan * aspect) as [number, number];
  const [t, b] = [1 - 2 * margins.top, 1 - 2 * margins.bottom].map((v) => v * tan) as [number, number];
  const most = { right: -Infinity, left: -Infinity, top: -Infinity, bottom: -Infinity };
  for (let at = 0; at < points.length; at += 3) {
    const along = (axis: Vec3): number => axis[0] * points[at]! + axis[1] * points[at + 1]! + axis[2] * points[at + 2]!;
    const [x, y, z] = [along(right), along(up), along(back)];
    most.right = Math.max(most.right, z + x / r);
    most.left = Math.max(most.left, z - x / l);
    most.top = Math.max(most.top, z + y / t);
    most.bottom = Math.max(most.bottom, z - y / b);
  }
  const least = (one: number, a: number, two: number, c: number): number => (one * a + two * c) / (a + c);
  const eye = Math.max(least(most.right, r, most.left, l), least(most.top, t, most.bottom, b)); // along `back`
  const middle = (one: number, a: number, two: number, c: number): number => ((one - eye) * a + (eye - two) * c) / 2;
  const [x, y] = [middle(most.right, r, most.left, l), middle(most.top, t, most.bottom, b)];
  const at = plus(plus(plus([0, 0, 0], right, x), up, y), back, eye);
  const seen = middleOf(points);
  const distance = Math.max(eye - (back[0] * seen[0] + back[1] * seen[1] + back[2] * seen[2]), 0.1);
  return { ...orbit, distance, target: plus(at, back, -distance) };
}

function middleOf(points: Float32Array): Vec3 {
  const sum: Vec3 = [0, 0, 0];
  for (let at = 0; at < points.length; at++) sum[(at % 3) as 0 | 1 | 2] += points[at]!;
  return sum.map((v) => (v * 3) / points.length) as Vec3;
}
