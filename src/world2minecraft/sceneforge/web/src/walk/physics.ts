// One tick of a player on foot: minecraft/physics/player_motion.py in TypeScript. Both pass
// tests/minecraft/physics/golden.json.

import type { Vec3 } from "../wire";
import {
  AIR_ACCELERATION,
  AIR_INERTIA,
  bodyBox,
  EDGE_STEP,
  FALL_DRAG,
  GRAVITY,
  GROUND_ACCELERATION,
  GROUND_INERTIA,
  JUMP_SPEED,
  JUMP_WAIT,
  KEY,
  NEGLIGIBLE,
  SNEAK,
  SPRINT,
  SPRINT_JUMP,
  STEP_HEIGHT,
  TOUCH,
  type Body,
  type Box,
  type Keys,
} from "./body";
import { climbed, movedBy, overlapsAny, swept } from "./sweep";

const MARGIN = 1; // blocks around what a tick can reach

/** Anything that knows its boxes: those that reach into low..high; more do no harm. */
export interface World {
  near(low: Vec3, high: Vec3): Box[];
}

/** The player a tick later; the game's yaw 0 looks to +z and grows clockwise from above. */
export function step(world: World, body: Body, keys: Keys, yawDeg: number, scale: number): Body {
  const boxes = around(world, body, scale);
  const touch = TOUCH * scale;
  const fits = !body.crouched || !overlapsAny(boxes, bodyBox(body.position, scale, false), touch);
  const crouched = keys.sneak || !fits;
  const sprints = keys.sprint && keys.forward && !keys.back && !crouched;
  const velocity = body.velocity.map((v) => (Math.abs(v) >= NEGLIGIBLE * scale ? v : 0)) as Vec3;
  if (body.onGround) velocity[1] = -GRAVITY * FALL_DRAG * scale;
  let wait = keys.jump ? Math.max(body.jumpWait - 1, 0) : 0;
  if (keys.jump && body.onGround && wait === 0) {
    velocity[1] = JUMP_SPEED * scale;
    wait = JUMP_WAIT;
    push(velocity, 0, sprints ? SPRINT_JUMP * scale : 0, yawDeg);
  }
  accelerate(velocity, body.onGround, keys, crouched, sprints, yawDeg, scale);
  const careful = crouched && body.onGround && velocity[1] <= 0;
  const way = careful ? keptFromEdges(boxes, body, velocity, scale) : ([...velocity] as Vec3);
  const gone = go(boxes, body, way, crouched, scale);
  const stopped = gone.map((value, axis) => Math.abs(value - way[axis as 0]) > touch);
  const inertia = body.onGround ? GROUND_INERTIA : AIR_INERTIA;
  const fall = stopped[1] ? 0 : velocity[1];
  return {
    position: body.position.map((value, axis) => value + gone[axis as 0]) as Vec3,
    velocity: [
      stopped[0] ? 0 : velocity[0] * inertia,
      (fall - GRAVITY * scale) * FALL_DRAG,
      stopped[2] ? 0 : velocity[2] * inertia,
    ],
    onGround: stopped[1] === true && way[1] < 0,
    crouched,
    jumpWait: wait,
    hitWall: stopped[0] === true || stopped[2] === true,
  };
}

function around(world: World, body: Body, scale: number): Box[] {
  const box = bodyBox(body.position, scale, false);
  const reach = body.velocity.map((v) => Math.abs(v) + MARGIN * scale) as Vec3;
  return world.near(
    [box[0] - reach[0], box[1] - reach[1], box[2] - reach[2]],
    [box[3] + reach[0], box[4] + reach[1], box[5] + reach[2]],
  );
}

function accelerate(
  velocity: Vec3,
  onGround: boolean,
  keys: Keys,
  crouched: boolean,
  sprints: boolean,
  yawDeg: number,
  scale: number,
): void {
  const slow = KEY * (crouched ? SNEAK : 1);
  const ahead = (Number(keys.forward) - Number(keys.back)) * slow;
  const aside = (Number(keys.left) - Number(keys.right)) * slow;
  const length = Math.hypot(ahead, aside);
  if (length < 0.01) return;
  const pace = onGround ? GROUND_ACCELERATION : AIR_ACCELERATION;
  const speed = (pace * scale * (sprints ? SPRINT : 1)) / Math.max(length, 1);
  push(velocity, aside * speed, ahead * speed, yawDeg);
}

/** Add to a velocity by where the player looks. */
function push(velocity: Vec3, left: number, ahead: number, yawDeg: number): void {
  const yaw = (yawDeg * Math.PI) / 180;
  const sine = Math.sin(yaw);
  const cosine = Math.cos(yaw);
  velocity[0] += left * cosine - ahead * sine;
  velocity[2] += ahead * cosine + left * sine;
}

/** How far a body comes, up steps where it stands or lands. */
function go(boxes: readonly Box[], body: Body, way: Vec3, crouched: boolean, scale: number): Vec3 {
  const box = bodyBox(body.position, scale, crouched);
  const touch = TOUCH * scale;
  const gone = swept(boxes, box, way, touch);
  const landed = way[1] < 0 && gone[1] - way[1] > touch;
  const blocked = Math.abs(gone[0] - way[0]) > touch || Math.abs(gone[2] - way[2]) > touch;
  if (!blocked || !(body.onGround || landed)) return gone;
  const up = climbed(boxes, box, way, STEP_HEIGHT * scale, touch);
  return up[0] ** 2 + up[2] ** 2 > gone[0] ** 2 + gone[2] ** 2 + touch ** 2 ? up : gone;
}

/** A way on the ground shortened so that something stays under the feet. */
function keptFromEdges(boxes: readonly Box[], body: Body, way: Vec3, scale: number): Vec3 {
  const box = bodyBox(body.position, scale, true);
  const back = EDGE_STEP * scale;
  const overNothing = (x: number, z: number): boolean =>
    !overlapsAny(boxes, movedBy(box, [x, -STEP_HEIGHT * scale, z]), TOUCH * scale);
  let [x, , z] = way;
  while (x && overNothing(x, 0)) x = nearer(x, back);
  while (z && overNothing(0, z)) z = nearer(z, back);
  while (x && z && overNothing(x, z)) [x, z] = [nearer(x, back), nearer(z, back)];
  return [x, way[1], z];
}

function nearer(value: number, by: number): number {
  return Math.abs(value) <= by ? 0 : value - Math.sign(value) * by;
}
