// Walking through a shared room: oneself, with keys or thumbs, or led by the planner while one
// watches from above or looks out of the walker's eyes.

import type { Packet } from "../build/packet";
import type { Pose } from "../view/sight";
import { HEIGHT } from "../walk/body";
import { Input } from "../walk/input";
import type { Thumbs } from "../walk/thumbs";
import { Led } from "../walk/led";
import { Route } from "../walk/route";
import { Walker } from "../walk/walker";
import type { Vec3 } from "../wire";
import type { RoomData, Thing } from "./data";
import { Figure } from "./figure";
import type { RoomView } from "./room_view";
import { Ways } from "./ways";

const CRUMB_M = 0.3;
const DIM_AT_NIGHT = 0.55;
const LEAST_ACROSS = (56 * Math.PI) / 180; // radians
const MOST_FIELD = (96 * Math.PI) / 180;

export interface StrollCalls {
  leave(): void; // walking is to end
  arrived(thing: Thing): void;
  broken(): void; // someone took over from the planner
}

export class Stroll {
  readonly walker: Walker;
  readonly figure: Figure;
  private readonly ways: Ways;
  private readonly input: Input;
  private led: { way: Led; thing: Thing } | null = null;
  private frame = 0;
  private last = 0;
  private isIn = false;
  private readonly cellsPerMetre: number;

  constructor(
    private readonly view: RoomView,
    private readonly room: RoomData,
    floor: Packet,
    thumbs: Thumbs,
    private readonly calls: StrollCalls,
  ) {
    this.walker = new Walker(floor);
    this.ways = new Ways(floor);
    this.figure = new Figure(HEIGHT * this.walker.scale);
    const matrix = room.facts.grid_to_room;
    this.cellsPerMetre = 1 / Math.hypot(matrix[0]!, matrix[4]!, matrix[8]!);
    view.blocks.group.add(this.figure.group);
    this.figure.group.visible = false;
    this.input = new Input(view.canvas, { leave: () => calls.leave(), moved: () => this.take() }, thumbs);
  }

  get isLed(): boolean {
    return this.led !== null;
  }

  /** How far a thing is to walk from here, in metres. */
  away(thing: Thing): number {
    const corners = this.ways.from(this.place, thing.way);
    return corners ? new Route(corners).length / this.cellsPerMetre : Infinity;
  }

  /** Look out of the walker's eyes. */
  enter(): void {
    this.isIn = true;
    this.view.isInside = true;
    this.figure.isSeen = false;
    this.input.start();
    (document.activeElement as HTMLElement | null)?.blur();
    this.view.pose = this.pose;
    this.run();
  }

  leave(): void {
    this.isIn = false;
    this.view.isInside = false;
    this.input.stop();
    this.figure.isSeen = true;
    this.figure.stand({ place: this.place, yawDeg: this.walker.yawDeg });
    this.figure.group.visible = true;
    this.view.pose = null;
    if (!this.led) this.stop();
  }

  /** Be led to a thing; how many metres it is, null where no way leads there. */
  lead(thing: Thing): number | null {
    const corners = this.ways.from(this.place, thing.way);
    if (!corners) return null;
    const route = new Route(corners);
    this.led = { way: new Led(route, this.middleOf(thing), this.cellsPerMetre), thing };
    this.figure.lay(route.crumbs(CRUMB_M * this.cellsPerMetre));
    this.figure.group.visible = true;
    this.figure.isSeen = !this.isIn;
    this.run();
    return route.length / this.cellsPerMetre;
  }

  /** Out of the picture, until somebody walks again. */
  hide(): void {
    this.led = null;
    this.figure.lay([]);
    this.figure.group.visible = false;
  }

  dim(isNight: boolean): void {
    this.figure.dim(isNight ? DIM_AT_NIGHT : 1);
  }

  /** Out of the walker's eyes; on a narrow screen one sees more above and below, not less aside. */
  private get pose(): Pose {
    const pose = this.walker.pose;
    const field = 2 * Math.atan(Math.tan(LEAST_ACROSS / 2) / this.view.aspect);
    return { ...pose, field: Math.min(Math.max(pose.field, field), MOST_FIELD) };
  }

  private get place(): Vec3 {
    return this.walker.body.position;
  }

  /** Keys and thumbs of a person count more than the planner. */
  private take(): void {
    if (!this.led || !this.isIn) return;
    this.led = null;
    this.figure.lay([]);
    this.calls.broken();
  }

  private run(): void {
    if (this.frame) return;
    this.last = performance.now();
    this.frame = requestAnimationFrame((now) => this.pass(now));
  }

  private stop(): void {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
  }

  private pass(now: number): void {
    this.frame = requestAnimationFrame((next) => this.pass(next));
    const milliseconds = Math.min(now - this.last, 250);
    this.last = now;
    if (this.led) this.follow(this.led, milliseconds);
    else if (this.isIn) this.steer(milliseconds);
    else this.stop();
  }

  private steer(milliseconds: number): void {
    const [right, down] = this.input.look(milliseconds);
    this.walker.look(right, down);
    this.walker.keys = this.input.keys;
    if (this.walker.pass(milliseconds) || right || down) this.view.pose = this.pose;
  }

  private follow({ way, thing }: { way: Led; thing: Thing }, milliseconds: number): void {
    const isDone = way.pass(this.walker, milliseconds);
    this.figure.stand({ place: this.place, yawDeg: this.walker.yawDeg }, way.hasArrived ? 0 : way.gone);
    if (this.isIn) this.view.pose = this.pose;
    this.view.invalidate();
    if (!isDone) return;
    this.led = null;
    this.figure.lay([]);
    this.calls.arrived(thing);
  }

  /** The middle of a thing, in cells. */
  private middleOf(thing: Thing): Vec3 {
    const box = this.room.mesh.boxOf(thing.id);
    if (!box) return this.place;
    return box.low.map((v, i) => (v + box.high[i as 0]) / 2) as Vec3;
  }
}
