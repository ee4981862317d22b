// Being led along a way: the pace rises and falls gently, corners are looked into before they come,
// and at the end one looks at what one came for.

import type { Vec3 } from "../wire";
import { yawTo, type Route } from "./route";
import type { Walker } from "./walker";

const PACE_M_S = 1.5;
const PACE_UP_M_S2 = 2; // and down
const LEAST_M_S = 0.15; // so that the end is reached
const LOOK_AHEAD_M = 0.5;
const TURN_DEG_S = 220;
const TURN_S = 0.18; // in which most of a turn is done
const LOOK_DOWN_DEG = 10;
const THERE_DEG = 0.5;

export class Led {
  gone = 0; // cells
  private pace = 0; // metres a second

  constructor(
    readonly route: Route,
    private readonly goal: Vec3, // in cells, looked at in the end
    private readonly cellsPerMetre: number,
  ) {}

  get hasArrived(): boolean {
    return this.gone >= this.route.length;
  }

  /** Put the walker further along the way; whether it is done. */
  pass(walker: Walker, milliseconds: number): boolean {
    const seconds = milliseconds / 1000;
    const left = (this.route.length - this.gone) / this.cellsPerMetre;
    const stop = Math.sqrt(2 * PACE_UP_M_S2 * left);
    this.pace = Math.max(Math.min(this.pace + PACE_UP_M_S2 * seconds, PACE_M_S, stop), LEAST_M_S);
    this.gone = Math.min(this.gone + this.pace * this.cellsPerMetre * seconds, this.route.length);
    const { place } = this.route.at(this.gone);
    const ahead = this.route.at(this.gone + LOOK_AHEAD_M * this.cellsPerMetre).place;
    const sight = this.hasArrived || left < LOOK_AHEAD_M ? this.goal : ahead;
    const turn = shortWay(walker.yawDeg, yawTo(place, sight));
    const most = TURN_DEG_S * seconds;
    const eased = turn * (1 - Math.exp(-seconds / TURN_S));
    const pitch = walker.pitchDeg + (LOOK_DOWN_DEG - walker.pitchDeg) * (1 - Math.exp(-seconds / (2 * TURN_S)));
    walker.put(place, walker.yawDeg + Math.min(Math.max(eased, -most), most), pitch);
    return this.hasArrived && Math.abs(turn) < THERE_DEG;
  }
}

/** Degrees from one yaw to another, the short way. */
export function shortWay(yaw: number, wanted: number): number {
  return ((((wanted - yaw + 180) % 360) + 360) % 360) - 180;
}
