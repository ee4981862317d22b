// What the page asks of the view; SceneView of view/ is one. Points on the screen are CSS pixels
// from the canvas's upper left corner, points of the room are metres.

import type { Run, Vec3 } from "../wire";

export interface Picked {
  cell: Vec3;
  flat: number;
  face: number; // 0..5: +x +y +z -x -y -z, the side that the ray came in through
  object?: number;
}

export interface Orbit {
  target: Vec3;
  azimuth: number;
  elevation: number;
  distance: number;
  ortho: boolean;
}

export interface ViewLike {
  readonly onFrame: ((milliseconds: number) => void)[];
  readonly controls: { claims: (event: PointerEvent) => boolean; readonly dragging: boolean };
  orbit: Orbit;
  pick(x: number, y: number): Picked | null;
  pointAt(x: number, y: number): Vec3 | null;
  project(pointM: Vec3): [number, number] | null;
  /** Where the ray through a pixel meets the plane `axis` = `at` metres. */
  toRoom(x: number, y: number, plane: { axis: 0 | 1 | 2; at: number }): Vec3 | null;
  cellsInRect(x0: number, y0: number, x1: number, y1: number, depthLimit: number): number[];
  cellsInLasso(polygon: readonly [number, number][], depthLimit: number): number[];
  setOverlay(name: string, runs: readonly Run[] | null, colour: Vec3): void;
  frame(): void;
  focus(box: { low: Vec3; high: Vec3 }): void;
  lookAlong(axis: 0 | 1 | 2, back?: boolean): void;
  invalidate(): void;
  idle(): Promise<void>;
}
