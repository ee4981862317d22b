// Who walks, and what the game says of them: walk/body.py in TypeScript. Coordinates are those of
// blocks: x east, y up, z south; lengths in blocks for a player of the game's size, times `scale`.

import type { Vec3 } from "../wire";

export type Box = readonly [number, number, number, number, number, number]; // low, high

export const TICKS_PER_S = 20;
export const WIDTH = 0.6;
export const HEIGHT = 1.8;
export const CROUCHED_HEIGHT = 1.5;
export const EYE = 1.62;
export const CROUCHED_EYE = 1.27;
export const STEP_HEIGHT = 0.6;
export const GRAVITY = 0.08;
export const FALL_DRAG = 0.98;
export const JUMP_SPEED = 0.42;
export const JUMP_WAIT = 10;
export const SPRINT_JUMP = 0.2;
export const GROUND_ACCELERATION = 0.1;
export const AIR_ACCELERATION = 0.02;
export const SPRINT = 1.3;
export const SNEAK = 0.3;
export const KEY = 0.98;
export const AIR_INERTIA = 0.91;
export const GROUND_INERTIA = 0.6 * AIR_INERTIA;
export const NEGLIGIBLE = 0.003;
export const TOUCH = 1e-7;
export const EDGE_STEP = 0.05;

/** What is held down during a tick. */
export interface Keys {
  forward: boolean;
  back: boolean;
  left: boolean;
  right: boolean;
  jump: boolean;
  sneak: boolean;
  sprint: boolean;
}

export const NO_KEYS: Keys = {
  forward: false,
  back: false,
  left: false,
  right: false,
  jump: false,
  sneak: false,
  sprint: false,
};

/** A player between two ticks. */
export interface Body {
  position: Vec3; // blocks, the middle of the feet
  velocity: Vec3; // blocks a tick
  onGround: boolean;
  crouched: boolean;
  jumpWait: number; // ticks
  hitWall: boolean; // in the last tick
}

export function bodyAt(position: Vec3): Body {
  const rest = { onGround: false, crouched: false, jumpWait: 0, hitWall: false };
  return { position, velocity: [0, 0, 0], ...rest };
}

/** The box of a body whose feet are at a position. */
export function bodyBox([x, y, z]: Vec3, scale: number, crouched: boolean): Box {
  const half = (WIDTH * scale) / 2;
  const height = (crouched ? CROUCHED_HEIGHT : HEIGHT) * scale;
  return [x - half, y, z - half, x + half, y + height, z + half];
}

export function eyeHeight(body: Body, scale: number): number {
  return (body.crouched ? CROUCHED_EYE : EYE) * scale;
}
