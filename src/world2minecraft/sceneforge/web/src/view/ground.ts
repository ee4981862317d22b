// A floor grid under the scene, a line each half metre, that fades out around it.

import * as THREE from "three";

import type { Vec3 } from "../wire";
import { flatMaterial } from "./plain";

const AROUND_M = 2.5;

export class Ground {
  readonly lines = new THREE.LineSegments(
    new THREE.BufferGeometry(),
    flatMaterial("#ffffff", 1, { colours: true }),
  );

  private of = "";

  constructor() {
    this.lines.frustumCulled = false;
    this.lines.renderOrder = -1;
  }

  /** Lie under a box, in metres. */
  take(low: Vec3, high: Vec3, dark: boolean): void {
    const wanted = [...low, ...high, dark].join();
    if (wanted === this.of) return;
    this.of = wanted;
    const size = Math.max(high[0] - low[0], high[1] - low[1]);
    const step = size > 40 ? 5 : size > 15 ? 1 : 0.5;
    const from = [0, 1].map((i) => Math.floor((low[i]! - AROUND_M) / step)) as [number, number];
    const to = [0, 1].map((i) => Math.ceil((high[i]! + AROUND_M) / step)) as [number, number];
    const places: number[] = [];
    const colours: number[] = [];
    const shade = dark ? 1 : 0;
    const put = (x: number, y: number, strong: boolean) => {
      const beyond = Math.max(low[0] - x, x - high[0], low[1] - y, y - high[1], 0);
      const alpha = Math.max(1 - beyond / AROUND_M, 0) ** 2 * (strong ? 0.22 : 0.11);
      places.push(x, y, low[2] - 0.004);
      colours.push(shade, shade, shade, alpha);
    };
    for (const axis of [0, 1] as const) {
      for (let line = from[axis]; line <= to[axis]; line++) {
        const other = axis === 0 ? 1 : 0;
        for (let part = from[other]; part < to[other]; part++) {
          for (const end of [part, part + 1]) {
            const at = axis === 0 ? [line, end] : [end, line];
            put(at[0]! * step, at[1]! * step, (line * step) % (step * 2) === 0);
          }
        }
      }
    }
    const { geometry } = this.lines;
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(places, 3));
    geometry.setAttribute("color", new THREE.Float32BufferAttribute(colours, 4));
  }

  dispose(): void {
    this.lines.geometry.dispose();
    this.lines.material.dispose();
  }
}
