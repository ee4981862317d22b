// Someone who walks: keys and looks in, a place to look from out. Ticks are the game's, twenty a
// second, however fast the picture is drawn; between two ticks the place is in between.

import * as THREE from "three";

import type { Packet } from "../build/packet";
import type { Pose } from "../view/view";
import type { Vec3 } from "../wire";
import { bodyAt, bodyBox, eyeHeight, NO_KEYS, TICKS_PER_S, type Body, type Box, type Keys } from "./body";
import { step } from "./physics";
import { overlapsAny } from "./sweep";
import { BlockWorld } from "./world";

const TICK_MS = 1000 / TICKS_PER_S;
const MOST_TICKS = 10; // at once: who slept half a second does not leap
const FIELD = (70 * Math.PI) / 180; // the game's
const STEEPEST = 89;
const LIFTS_M = [0.02, 0.1, 0.25, 0.6, 1.2]; // tried where another world's ground is higher
const DEEPEST = 200; // blocks a person falls before he is put back

interface Told {
  rev: number;
  blocks_per_metre: number;
  grid_to_room: number[];
  feet: Vec3;
  yaw_deg: number;
}

export class Walker {
  keys: Keys = NO_KEYS;
  yawDeg: number;
  pitchDeg = 8; // down a little: the room, not its ceiling
  body: Body;
  private before: Body;
  private rest = 0;
  readonly scale: number;
  readonly rev: number;
  private readonly world: BlockWorld;
  private readonly start: Vec3;
  private readonly toRoom: THREE.Matrix4;

  constructor(packet: Packet) {
    const told = packet.told as unknown as Told;
    this.world = BlockWorld.of(packet);
    this.scale = told.blocks_per_metre;
    this.rev = told.rev;
    this.start = told.feet;
    this.yawDeg = told.yaw_deg;
    this.toRoom = new THREE.Matrix4().fromArray(told.grid_to_room).transpose();
    this.body = this.before = bodyAt(told.feet);
  }

  /** Look by degrees: right and down. */
  look(right: number, down: number): void {
    this.yawDeg += right;
    this.pitchDeg = Math.min(Math.max(this.pitchDeg + down, -STEEPEST), STEEPEST);
  }

  /** Let time go by; whether the eyes are elsewhere than before. */
  pass(milliseconds: number): boolean {
    const still = this.isStill;
    this.rest = Math.min(this.rest + milliseconds, MOST_TICKS * TICK_MS);
    while (this.rest >= TICK_MS) {
      this.rest -= TICK_MS;
      this.before = this.body;
      this.body = step(this.world, this.body, this.keys, this.yawDeg, this.scale);
      if (this.start[1] - this.body.position[1] > DEEPEST) this.body = this.before = bodyAt(this.start);
    }
    return !still || !this.isStill;
  }

  /** Stand where another walker stands, or a little higher; at the start where that is taken. */
  standAt(other: Walker): void {
    const [x, y, z] = this.blocksOf(other.feet);
    const box = (lift: number): Box => bodyBox([x, y + lift * this.scale, z], this.scale, false);
    const isFree = (b: Box): boolean => !overlapsAny(this.world.near([b[0], b[1], b[2]], [b[3], b[4], b[5]]), b);
    const lift = LIFTS_M.find((one) => isFree(box(one)));
    if (lift !== undefined) this.body = this.before = bodyAt([x, y + lift * this.scale, z]);
    [this.yawDeg, this.pitchDeg] = [other.yawDeg, other.pitchDeg];
  }

  /** Stand at a place, in blocks, and look that way: someone else does the walking. */
  put(place: Vec3, yawDeg: number, pitchDeg: number): void {
    this.body = this.before = { ...bodyAt(place), onGround: true };
    this.rest = 0;
    [this.yawDeg, this.pitchDeg] = [yawDeg, pitchDeg];
  }

  /** A point of the room in blocks. */
  blocksOf(point_m: Vec3): Vec3 {
    return new THREE.Vector3(...point_m).applyMatrix4(this.toRoom.clone().invert()).toArray();
  }

  private get isStill(): boolean {
    const { before, body } = this;
    return before.crouched === body.crouched && before.position.every((v, i) => v === body.position[i]);
  }

  get feet(): Vec3 {
    return this.roomOf(this.body.position);
  }

  /** Where one looks from now, in metres of the room. */
  get pose(): Pose {
    const share = this.rest / TICK_MS;
    const between = this.before.position.map((v, i) => v + (this.body.position[i]! - v) * share) as Vec3;
    between[1] += eyeHeight(this.body, this.scale);
    return { position: this.roomOf(between), forward: this.forward, up: [0, 0, 1], field: FIELD };
  }

  private get forward(): Vec3 {
    const [yaw, pitch] = [this.yawDeg, this.pitchDeg].map((deg) => (deg * Math.PI) / 180) as [number, number];
    const flat = Math.cos(pitch);
    const ahead = new THREE.Vector3(-Math.sin(yaw) * flat, -Math.sin(pitch), Math.cos(yaw) * flat);
    return ahead.transformDirection(this.toRoom).toArray();
  }

  private roomOf(point: Vec3): Vec3 {
    return new THREE.Vector3(...point).applyMatrix4(this.toRoom).toArray();
  }
}
