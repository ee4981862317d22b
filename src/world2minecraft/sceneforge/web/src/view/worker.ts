// A worker that holds the labels of a scene and meshes the chunks it is asked for.

import { meshChunk, type ChunkMesh, type Style } from "./mesher";
import type { Vec3 } from "../wire";

export interface LoadOrder {
  type: "load";
  epoch: number;
  labels: Uint8Array;
  shape: Vec3;
}

export interface MeshOrder {
  type: "mesh";
  epoch: number;
  key: number;
  low: Vec3;
  step: number;
  style: Style;
}

export interface Meshed {
  epoch: number;
  key: number;
  step: number;
  style: Style;
  mesh: ChunkMesh;
}

let loaded: LoadOrder | null = null;

self.onmessage = ({ data }: MessageEvent<LoadOrder | MeshOrder>) => {
  if (data.type === "load") {
    loaded = data;
    return;
  }
  if (!loaded) return;
  const { epoch, key, step, style } = data;
  const mesh = meshChunk(loaded.labels, loaded.shape, data.low, step, style);
  const answer: Meshed = { epoch, key, step, style, mesh };
  self.postMessage(answer, { transfer: [mesh.words.buffer] });
};
