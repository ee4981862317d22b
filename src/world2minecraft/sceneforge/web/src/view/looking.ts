// Where the scene is looked at from, and the ways to change it: jumps, flights, poses.

import type { Store } from "../store";
import type { Vec3 } from "../wire";
import { fitted, panned, turned, zoomed, type Orbit } from "./camera";
import { Sight, type Pose } from "./sight";

/** From where a scene is first seen: obliquely from above, the front at the left. */
export const START: Orbit = {
  target: [0, 0, 0],
  azimuth: (-125 * Math.PI) / 180,
  elevation: (50 * Math.PI) / 180,
  distance: 8,
  ortho: false,
};

export abstract class Looking {
  abstract readonly canvas: HTMLCanvasElement;
  abstract readonly store: Store;
  protected readonly sight = new Sight(START);

  abstract invalidate(): void;

  get orbit(): Orbit {
    return this.sight.orbit;
  }

  set orbit(orbit: Orbit) {
    this.sight.orbit = orbit;
    this.invalidate();
  }

  /** Stand where a photo was taken or someone walks; null: orbit again. */
  get pose(): Pose | null {
    return this.sight.pose;
  }

  set pose(pose: Pose | null) {
    this.sight.pose = pose;
    this.invalidate();
  }

  /** Where a point in metres is on the canvas, in pixels; null: behind the camera. */
  project(point: Vec3): [number, number] | null {
    return this.measure().project(point);
  }

  /** Fly to where the whole scene is in view. */
  frame(): void {
    const box = this.box();
    if (box) this.flyTo(fitted({ ...this.sight.goal }, box.low, box.high, this.measure().aspect));
  }

  /** Fly to where a box, in metres, fills the view. */
  focus(box: { low: Vec3; high: Vec3 }): void {
    const room = box.low.map((l, i) => Math.max((box.high[i]! - l) * 0.35, 0.15));
    const low = box.low.map((l, i) => l - room[i]!) as Vec3;
    const high = box.high.map((h, i) => h + room[i]!) as Vec3;
    this.flyTo(fitted(this.sight.goal, low, high, this.measure().aspect));
  }

  /** Turn the camera round its target, by radians. */
  turn(azimuth: number, elevation: number): void {
    this.flyTo(turned(this.sight.goal, azimuth, elevation));
  }

  /** Move what is seen by shares of the view's height. */
  pan(right: number, up: number): void {
    this.flyTo(panned(this.sight.goal, right, up));
  }

  /** Come closer (less than 1) or go away. */
  zoom(factor: number): void {
    this.flyTo(zoomed(this.sight.goal, factor, null));
  }

  /** Look along an axis: 0 and 1 from -x and -y, 2 from the top; `back` from the other side. */
  lookAlong(axis: 0 | 1 | 2, back = false): void {
    const half = Math.PI / 2;
    const azimuth = axis === 2 ? -half : axis === 0 ? (back ? 0 : Math.PI) : back ? half : -half;
    const elevation = axis === 2 ? (back ? -1 : 1) * (half - 1e-4) : 0;
    this.flyTo({ ...this.sight.goal, azimuth, elevation });
  }

  /** Look from a side, 0..5: +x +y +z -x -y -z; from the other where it is seen from there. */
  lookFrom(side: number): void {
    const axis = (side % 3) as 0 | 1 | 2;
    const back = axis === 2 ? side > 2 : side < 3;
    const ahead = Math.abs(this.sight.axes.back[axis]) > 0.999;
    this.lookAlong(axis, ahead ? !back : back);
  }

  flyTo(to: Orbit): void {
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.sight.fly(to, performance.now(), calm);
    this.invalidate();
  }

  protected box(): { low: Vec3; high: Vec3 } | null {
    const { scene } = this.store.get();
    if (!scene) return null;
    const high = scene.origin_m.map((o, i) => o + scene.shape[i]! * scene.voxel_m) as Vec3;
    return { low: scene.origin_m, high };
  }

  protected measure(): Sight {
    this.sight.resize(this.canvas.clientWidth, this.canvas.clientHeight);
    return this.sight;
  }
}
