// Where the camera stands, as numbers: an orbit around a target, z up. No three.js in here.

import type { Vec3 } from "../wire";

export interface Orbit {
  target: Vec3; // metres
  azimuth: number; // radians; 0 looks along -x from +x, counted towards +y
  elevation: number; // radians above the floor, -90° .. 90°
  distance: number; // metres from the target
  ortho: boolean;
}

export const FIELD = (40 * Math.PI) / 180; // vertical angle of view; as a 50 mm lens, near enough
const STEEPEST = Math.PI / 2 - 1e-4;
const NEAREST_M = 0.05;
const FARTHEST_M = 4000;

/** Unit vectors: where the camera is from the target, its right and its up. */
export function axesOf(orbit: Orbit): { back: Vec3; right: Vec3; up: Vec3 } {
  const { azimuth: a, elevation: e } = orbit;
  const back: Vec3 = [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
  const right: Vec3 = [-Math.sin(a), Math.cos(a), 0];
  const up: Vec3 = [-Math.sin(e) * Math.cos(a), -Math.sin(e) * Math.sin(a), Math.cos(e)];
  return { back, right, up };
}

export function eyeOf(orbit: Orbit): Vec3 {
  return plus(orbit.target, axesOf(orbit).back, orbit.distance);
}

/** Half the height of what is seen at the target, in metres. */
export function halfHeight(orbit: Orbit): number {
  return orbit.distance * Math.tan(FIELD / 2);
}

export function turned(orbit: Orbit, azimuth: number, elevation: number): Orbit {
  const e = Math.min(Math.max(orbit.elevation + elevation, -STEEPEST), STEEPEST);
  return { ...orbit, azimuth: orbit.azimuth + azimuth, elevation: e };
}

/** Move the scene under the pointer by shares of the view's height. */
export function panned(orbit: Orbit, right: number, up: number): Orbit {
  const axes = axesOf(orbit);
  const scale = 2 * halfHeight(orbit);
  const target = plus(plus(orbit.target, axes.right, -right * scale), axes.up, -up * scale);
  return { ...orbit, target };
}

/** Bring the camera nearer (factor < 1) and keep `point`, in metres, where it is on the screen. */
export function zoomed(orbit: Orbit, factor: number, point: Vec3 | null): Orbit {
  const distance = Math.min(Math.max(orbit.distance * factor, NEAREST_M), FARTHEST_M);
  const share = distance / orbit.distance;
  const about = point ?? orbit.target;
  const target = about.map((p, i) => p + (orbit.target[i]! - p) * share) as Vec3;
  return { ...orbit, distance, target };
}

/** See the whole of a box, in metres, from the same side. */
export function fitted(orbit: Orbit, low: Vec3, high: Vec3, aspect: number): Orbit {
  const target = low.map((l, i) => (l + high[i]!) / 2) as Vec3;
  const { back, right, up } = axesOf(orbit);
  const tan = Math.tan(FIELD / 2);
  let distance = NEAREST_M;
  for (let corner = 0; corner < 8; corner++) {
    const from = target.map((t, i) => ((corner >> i) & 1 ? high[i]! : low[i]!) - t) as Vec3;
    const wide = Math.abs(dot(from, right)) / (tan * aspect);
    const tall = Math.abs(dot(from, up)) / tan;
    distance = Math.max(distance, Math.max(wide, tall) + (orbit.ortho ? 0 : dot(from, back)));
  }
  return { ...orbit, target, distance: distance * 1.04 };
}

/** A point between two stands, for a flight; angles go the short way round. */
export function between(from: Orbit, to: Orbit, share: number): Orbit {
  const s = share * share * (3 - 2 * share);
  const mix = (a: number, b: number) => a + (b - a) * s;
  const turn = shortWay(to.azimuth - from.azimuth);
  return {
    target: from.target.map((t, i) => mix(t, to.target[i]!)) as Vec3,
    azimuth: from.azimuth + turn * s,
    elevation: mix(from.elevation, to.elevation),
    distance: Math.exp(mix(Math.log(from.distance), Math.log(to.distance))),
    ortho: to.ortho,
  };
}

export function shortWay(angle: number): number {
  const full = 2 * Math.PI;
  return ((((angle + Math.PI) % full) + full) % full) - Math.PI;
}

/** Pixels of a view w x h, from the top left, to the ray through them. Not of unit length. */
export function rayAt(orbit: Orbit, x: number, y: number, w: number, h: number): { from: Vec3; direction: Vec3 } {
  const { back, right, up } = axesOf(orbit);
  const a = ((2 * x) / w - 1) * (w / h);
  const b = 1 - (2 * y) / h;
  const half = halfHeight(orbit);
  if (orbit.ortho) {
    const plane = plus(plus(orbit.target, right, a * half), up, b * half);
    return { from: plus(plane, back, FARTHEST_M / 4), direction: plus([0, 0, 0], back, -1) };
  }
  const tan = Math.tan(FIELD / 2);
  const direction = plus(plus(plus([0, 0, 0], back, -1), right, a * tan), up, b * tan);
  return { from: eyeOf(orbit), direction };
}

export function plus(a: Vec3, b: Vec3, scale: number): Vec3 {
  return [a[0] + b[0] * scale, a[1] + b[1] * scale, a[2] + b[2] * scale];
}

export function dot(a: Vec3, b: Vec3): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
