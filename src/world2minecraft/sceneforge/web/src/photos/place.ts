// Where a photo was taken, as a stand of the view, and where its picture lies on the canvas.

import type { Orbit } from "../view/camera";
import type { Pose } from "../view/sight";
import type { Vec3 } from "../wire";

export interface Frame {
  n: number;
  name: string;
  camera_to_room: number[][]; // OpenCV: x right, y down, z forward
  vertical_fov_deg: number;
  aspect: number; // width over height
  is_depth: boolean;
}

/** Stand where the photo was taken and see all of it in a canvas of these proportions. */
export function poseOf(frame: Frame, canvasAspect: number): Pose {
  const half = (frame.vertical_fov_deg * Math.PI) / 360;
  const wider = Math.max(frame.aspect / canvasAspect, 1);
  return {
    position: column(frame, 3),
    forward: column(frame, 2),
    up: column(frame, 1).map((value) => -value) as Vec3,
    field: 2 * Math.atan(Math.tan(half) * wider),
  };
}

/** The photo's rectangle on a canvas, in its pixels: left, top, width, height. */
export function boxOf(frame: Frame, width: number, height: number): [number, number, number, number] {
  const tall = Math.min(height, width / frame.aspect);
  const wide = tall * frame.aspect;
  return [(width - wide) / 2, (height - tall) / 2, wide, tall];
}

/** A stand between two; the directions stay of unit length. */
export function between(from: Pose, to: Pose, share: number): Pose {
  const s = share * share * (3 - 2 * share);
  const mix = (a: Vec3, b: Vec3): Vec3 => a.map((one, i) => one + (b[i]! - one) * s) as Vec3;
  return {
    position: mix(from.position, to.position),
    forward: unit(mix(from.forward, to.forward), to.forward),
    up: unit(mix(from.up, to.up), to.up),
    field: from.field + (to.field - from.field) * s,
  };
}

/** Orbit what a stand looks at, so that leaving a photo does not throw the view elsewhere. */
export function orbitAt({ position, forward }: Pose, distance: number): Orbit {
  return {
    target: position.map((one, i) => one + forward[i]! * distance) as Vec3,
    azimuth: Math.atan2(-forward[1], -forward[0]),
    elevation: Math.asin(Math.min(Math.max(-forward[2], -1), 1)),
    distance,
    ortho: false,
  };
}

/** The lines of a small pyramid for each photo, in metres: eight ends of lines for each. */
export function pyramids(frames: readonly Frame[], deep: number): Float32Array {
  const ends: number[] = [];
  for (const frame of frames) {
    const tall = deep * Math.tan((frame.vertical_fov_deg * Math.PI) / 360);
    const wide = tall * frame.aspect;
    const eye = column(frame, 3);
    const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) => at(frame, [x! * wide, y! * tall, deep]));
    corners.forEach((corner, i) => ends.push(...eye, ...corner, ...corner, ...corners[(i + 1) % 4]!));
  }
  return Float32Array.from(ends);
}

function at(frame: Frame, [x, y, z]: Vec3): Vec3 {
  return [0, 1, 2].map((row) => {
    const [a, b, c, d] = frame.camera_to_room[row]!;
    return a! * x + b! * y + c! * z + d!;
  }) as Vec3;
}

function column(frame: Frame, index: number): Vec3 {
  return [0, 1, 2].map((row) => frame.camera_to_room[row]![index]!) as Vec3;
}

function unit(a: Vec3, otherwise: Vec3): Vec3 {
  const length = Math.hypot(...a);
  return length > 1e-6 ? (a.map((one) => one / length) as Vec3) : otherwise;
}
