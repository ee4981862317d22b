// The material that all chunks share, and what its uniforms mean.

import * as THREE from "three";

import type { ColourBy } from "../store";
import { FRAGMENT, VERTEX } from "./shader";
import type { Vec3 } from "../wire";

export class VoxelMaterial {
  readonly uniforms = {
    palette: { value: Array.from({ length: 16 }, () => new THREE.Vector4(1, 1, 1, 0)) },
    origin: { value: new THREE.Vector3() },
    voxel: { value: 1 },
    boxLow: { value: new THREE.Vector3() },
    boxHigh: { value: new THREE.Vector3(1, 1, 1) },
    shrink: { value: 1 },
    overlap: { value: new THREE.Vector2() },
    solid: { value: null as THREE.Data3DTexture | null },
    field: { value: null as THREE.Data3DTexture | null },
    shape: { value: new THREE.Vector3(1, 1, 1) },
    edges: { value: 0.2 },
    opacity: { value: 1 },
    grain: { value: 0 },
  };

  readonly greedy = this.variant({});
  readonly cubes = this.variant({ CUBES: "" });

  private variant(defines: Record<string, string>): THREE.RawShaderMaterial {
    return new THREE.RawShaderMaterial({
      glslVersion: THREE.GLSL3,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: this.uniforms,
      defines,
    });
  }

  setPlace(voxel: number, origin: Vec3, shape: Vec3): void {
    this.uniforms.voxel.value = voxel;
    this.uniforms.origin.value.set(...origin);
    this.uniforms.shape.value.set(shape[0] + 2, shape[1] + 2, shape[2] + 2);
  }

  setBox(low: Vec3, high: Vec3): void {
    this.uniforms.boxLow.value.set(...low);
    this.uniforms.boxHigh.value.set(...high);
  }

  /** How far quads overlap, in cells: everywhere, or at a metre from the eye and more beyond. */
  setOverlap(cells: number, everywhere: boolean): void {
    this.uniforms.overlap.value.set(everywhere ? 0 : cells, everywhere ? cells : 0);
  }

  /** Colours 0..255 and whether each class is drawn, by class id. */
  setClasses(colours: readonly Vec3[], visible: ArrayLike<boolean>): void {
    this.uniforms.palette.value.forEach((entry, id) => {
      const [r, g, b] = colours[id] ?? [255, 255, 255];
      entry.set(r / 255, g / 255, b / 255, visible[id] ? 1 : 0);
    });
  }

  /** Switch whole parts of the shader on or off; each combination is compiled once. */
  setParts(parts: { edges: boolean; shadows: boolean; opacity: number; by: ColourBy }): void {
    this.uniforms.opacity.value = parts.opacity;
    const wanted = {
      EDGES: parts.edges,
      SHADOWS: parts.shadows,
      SCREEN_DOOR: parts.opacity < 1,
      BY_CONFIDENCE: parts.by === "confidence",
      BY_COLOUR: parts.by === "colour",
      BY_DIFFERENCE: parts.by === "difference",
    };
    for (const material of [this.greedy, this.cubes]) {
      const defines = material.defines as Record<string, string>;
      for (const [name, on] of Object.entries(wanted)) {
        if (on === name in defines) continue;
        if (on) defines[name] = "";
        else delete defines[name];
        material.needsUpdate = true;
      }
    }
  }

  dispose(): void {
    this.greedy.dispose();
    this.cubes.dispose();
    this.uniforms.solid.value?.dispose();
    this.uniforms.field.value?.dispose();
  }
}
