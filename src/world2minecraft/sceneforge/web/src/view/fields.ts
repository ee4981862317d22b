// A value for each cell that faces are coloured by: confidence, the photos' colour, a difference.

import * as THREE from "three";

import type { ColourBy } from "../store";
import type { Run, Vec3 } from "../wire";
import type { VoxelMaterial } from "./material";

/** Which cells another scene has more, less or otherwise. */
export interface Difference {
  added: readonly Run[];
  removed: readonly Run[];
  changed: readonly Run[];
}

const ADDED = 1;
const CHANGED = 2;

export class Fields {
  private difference: Uint8Array | null = null;
  private colour: { data: Uint8Array; rev: number } | null = null;
  private loading = -1;
  private of = "";

  constructor(
    private readonly material: VoxelMaterial,
    private readonly changed: () => void,
  ) {}

  setDifference(difference: Difference | null, cells: number): void {
    this.difference = difference && new Uint8Array(cells);
    for (const [code, runs] of [[ADDED, difference?.added], [CHANGED, difference?.changed]] as const) {
      for (const [first, length] of runs ?? []) this.difference!.fill(code, first, first + length);
    }
    this.of = "";
  }

  /** Bring what `by` needs to the GPU. Returns what can be shown now: colours come later. */
  take(by: ColourBy, shape: Vec3, confidence: Uint8Array, rev: number): ColourBy {
    const cells = shape[0] * shape[1] * shape[2];
    const wanted = `${by} ${rev} ${shape.join()}`;
    if (by === "class") return by;
    if (by === "colour" && this.colour?.rev !== rev) void this.load(rev, cells);
    const data = {
      confidence: confidence.length === cells ? confidence : null,
      colour: this.colour?.data ?? null,
      difference: this.difference ?? new Uint8Array(cells),
    }[by];
    if (!data || data.length < cells) return "class";
    if (this.of !== wanted || (by === "colour" && this.colour?.rev === rev)) {
      this.upload(data, shape, data.length === cells * 4);
      this.of = wanted;
    }
    return by;
  }

  private upload(data: Uint8Array, shape: Vec3, rgba: boolean): void {
    const { field } = this.material.uniforms;
    field.value?.dispose();
    const texture = new THREE.Data3DTexture(data, shape[2], shape[1], shape[0]);
    texture.format = rgba ? THREE.RGBAFormat : THREE.RedFormat;
    texture.unpackAlignment = 1;
    texture.needsUpdate = true;
    field.value = texture;
  }

  private async load(rev: number, cells: number): Promise<void> {
    if (this.loading === rev) return;
    this.loading = rev;
    const answer = await fetch("api/volume?what=colour").catch(() => null);
    this.loading = -1;
    if (!answer?.ok) return;
    const rgb = new Uint8Array(await answer.arrayBuffer()).subarray(-3 * cells);
    if (rgb.length !== 3 * cells) return;
    const data = new Uint8Array(4 * cells);
    for (let cell = 0; cell < cells; cell++) {
      data[4 * cell] = rgb[3 * cell]!;
      data[4 * cell + 1] = rgb[3 * cell + 1]!;
      data[4 * cell + 2] = rgb[3 * cell + 2]!;
    }
    this.colour = { data, rev };
    this.of = "";
    this.changed();
  }
}
