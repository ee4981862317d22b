// A small cube in the corner that turns with the camera. A click on a side looks from there.

import { TEXT } from "../text";
import type { Vec3 } from "../wire";
import { dot } from "./camera";

const SPACE = "http://www.w3.org/2000/svg";
const HALF = 21; // pixels from the cube's middle to a side
const SIZE = 92;
const NORMALS: readonly Vec3[] = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]];
// Which way a word on a side runs and which way is up for it, seen from outside.
const RIGHT: readonly Vec3[] = [[0, 1, 0], [-1, 0, 0], [1, 0, 0], [0, -1, 0], [1, 0, 0], [1, 0, 0]];
const UP: readonly Vec3[] = [[0, 0, 1], [0, 0, 1], [0, 1, 0], [0, 0, 1], [0, 0, 1], [0, -1, 0]];

export interface Axes {
  back: Vec3;
  right: Vec3;
  up: Vec3;
}

/** The flat picture of a side: an SVG matrix from its own plane, y down; null: it faces away. */
export function sideMatrix(side: number, { back, right, up }: Axes): number[] | null {
  if (dot(NORMALS[side]!, back) < 0.02) return null;
  const flat = (axis: Vec3): [number, number] => [dot(axis, right), -dot(axis, up)];
  const [along, down] = [flat(RIGHT[side]!), flat(UP[side]!.map((v) => -v) as Vec3)];
  const middle = flat(NORMALS[side]!).map((v) => v * HALF);
  return [...along, ...down, ...middle];
}

export class Compass {
  private readonly root = document.createElementNS(SPACE, "svg");
  private readonly sides: SVGGElement[];

  constructor(canvas: HTMLCanvasElement, look: (side: number) => void) {
    this.root.setAttribute("class", "compass");
    this.root.setAttribute("viewBox", `${-SIZE / 2} ${-SIZE / 2} ${SIZE} ${SIZE}`);
    this.root.setAttribute("aria-hidden", "true"); // The page's own buttons do the same.
    this.sides = NORMALS.map((_, side) => this.side(side, () => look(side)));
    canvas.after(this.root);
  }

  /** Turn with the camera; null: there is nothing to turn. */
  turn(axes: Axes | null): void {
    this.root.classList.toggle("is-off", axes === null);
    this.sides.forEach((node, side) => {
      const matrix = axes && sideMatrix(side, axes);
      node.classList.toggle("is-off", !matrix);
      if (!axes || !matrix) return;
      node.setAttribute("transform", `matrix(${matrix.map((v) => v.toFixed(4)).join(" ")})`);
      node.classList.toggle("is-ahead", dot(NORMALS[side]!, axes.back) > 0.995);
    });
  }

  dispose(): void {
    this.root.remove();
  }

  private side(side: number, look: () => void): SVGGElement {
    const group = document.createElementNS(SPACE, "g");
    group.setAttribute("class", `compass-side is-${"xyz"[side % 3]}`);
    const square = document.createElementNS(SPACE, "rect");
    for (const [name, value] of Object.entries({ x: -HALF, y: -HALF, width: 2 * HALF, height: 2 * HALF, rx: 3 })) {
      square.setAttribute(name, String(value));
    }
    const word = document.createElementNS(SPACE, "text");
    word.textContent = TEXT.compass[side]!;
    group.append(square, word);
    group.addEventListener("click", look);
    this.root.append(group);
    return group;
  }
}
