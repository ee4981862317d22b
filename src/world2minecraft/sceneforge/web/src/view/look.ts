// The store's words for how voxels look, brought to the material: which classes, how they are
// coloured, cut, shrunken, seen through.

import type { State } from "../store";
import type { Vec3 } from "../wire";
import type { Caps } from "./caps";
import type { Chunks } from "./chunks";
import type { Fields } from "./fields";
import type { VoxelMaterial } from "./material";
import type { Seen } from "./pick";
import { seenOf } from "./seen";
import { solidTexture } from "./solid";

const WHOLE = 0.995; // share of a cell from which on cubes touch

export class Look {
  seen: Seen = { visible: [], low: [0, 0, 0], high: [0, 0, 0] };
  private shadowsOf = "";

  constructor(
    private readonly material: VoxelMaterial,
    private readonly chunks: Chunks,
    readonly fields: Fields,
    private readonly caps: Caps,
  ) {}

  /** Cells changed: shadows are other ones. */
  forget(): void {
    this.shadowsOf = "";
    this.caps.forget();
  }

  take({ scene, view, confidence }: Readonly<State>, labels: Uint8Array): void {
    if (!scene || !labels.length) return;
    this.seen = seenOf(view, scene.shape);
    const colours: Vec3[] = [];
    for (const { id, colour } of scene.classes) colours[id] = colour;
    this.material.setClasses(colours, this.seen.visible);
    this.material.setBox(this.seen.low, this.seen.high);
    this.material.uniforms.shrink.value = view.voxelSize;
    this.chunks.setStyle(view.voxelSize < WHOLE ? "cubes" : "greedy");
    const shadows = this.takeShadows(labels, scene.shape);
    const by = this.fields.take(view.colourBy, scene.shape, confidence, scene.rev);
    this.material.setParts({ edges: view.edges, shadows, opacity: view.opacity, by });
    this.caps.take(labels, scene.shape, this.seen, view.voxelSize >= WHOLE);
  }

  private takeShadows(labels: Uint8Array, shape: Vec3): boolean {
    const { solid } = this.material.uniforms;
    const wanted = this.seen.visible.length ? Array.from(this.seen.visible, Number).join("") : "";
    if (wanted !== this.shadowsOf) {
      this.shadowsOf = wanted;
      solid.value?.dispose();
      solid.value = solidTexture({ labels, shape }, this.seen.visible);
    }
    return solid.value !== null;
  }
}
