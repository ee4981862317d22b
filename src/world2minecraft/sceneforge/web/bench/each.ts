// What D3-like tools do: one drawn thing for each voxel, farthest first. For comparison only.

import * as THREE from "three";

import { axesOf, eyeOf, fitted, FIELD, halfHeight, type Orbit } from "../src/view/camera";
import { cellOf, isOccupied } from "../src/view/volume";
import type { Scene, Vec3 } from "../src/wire";

export function drawEach(canvas: HTMLCanvasElement, scene: Scene, labels: Uint8Array, how: string): void {
  const cells: number[] = [];
  labels.forEach((label, flat) => isOccupied(label) && label !== 1 && cells.push(flat));
  const high = scene.origin_m.map((o, i) => o + scene.shape[i]! * scene.voxel_m) as Vec3;
  const start: Orbit = { target: [0, 0, 0], azimuth: -2.2, elevation: 0.73, distance: 8, ortho: false };
  let orbit = fitted(start, scene.origin_m, high, innerWidth / innerHeight);
  const draw = how === "svg" ? svgDrawer(canvas, scene, labels, cells) : boxDrawer(canvas, scene, labels, cells);
  draw(orbit);
  performance.mark("scene-first");
  performance.mark("scene-whole");
  const turn = () => {
    orbit = { ...orbit, azimuth: orbit.azimuth + 0.05 };
    draw(orbit);
  };
  Object.assign(window, { __forge: { turn } });
}

type Draw = (orbit: Orbit) => void;

/** An SVG square for each voxel: what the paper's tool does with D3. */
function svgDrawer(canvas: HTMLCanvasElement, scene: Scene, labels: Uint8Array, cells: number[]): Draw {
  const space = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(space, "svg");
  svg.setAttribute("width", String(innerWidth));
  svg.setAttribute("height", String(innerHeight));
  canvas.replaceWith(svg);
  const nodes = cells.map((flat) => {
    const node = document.createElementNS(space, "rect");
    const [r, g, b] = scene.classes[labels[flat]!]!.colour;
    node.setAttribute("fill", `rgb(${r},${g},${b})`);
    return node;
  });
  svg.append(...nodes);
  return (orbit) => {
    const { back, right, up } = axesOf(orbit);
    const eye = eyeOf(orbit);
    const far = halfHeight(orbit) / orbit.distance;
    const placed = cells.map((flat, i) => {
      const at = cellOf(scene.shape, flat).map((c, a) => scene.origin_m[a]! + (c + 0.5) * scene.voxel_m - eye[a]!);
      const along = (axis: Vec3) => at[0]! * axis[0] + at[1]! * axis[1] + at[2]! * axis[2];
      return { node: nodes[i]!, deep: -along(back), x: along(right), y: along(up) };
    });
    placed.sort((a, b) => b.deep - a.deep);
    for (const { node, deep, x, y } of placed) {
      const scale = innerHeight / (2 * far * deep);
      const side = scene.voxel_m * scale * 1.4;
      node.setAttribute("x", String(innerWidth / 2 + x * scale - side / 2));
      node.setAttribute("y", String(innerHeight / 2 - y * scale - side / 2));
      node.setAttribute("width", String(side));
      node.setAttribute("height", String(side));
      svg.append(node);
    }
    svg.getBoundingClientRect();
  };
}

/** A cube for each voxel, drawn by one instanced call. */
function boxDrawer(canvas: HTMLCanvasElement, scene: Scene, labels: Uint8Array, cells: number[]): Draw {
  const renderer = new THREE.WebGLRenderer({ canvas });
  renderer.setSize(innerWidth, innerHeight, false);
  const side = scene.voxel_m;
  const mesh = new THREE.InstancedMesh(new THREE.BoxGeometry(side, side, side), new THREE.MeshBasicMaterial(), cells.length);
  const matrix = new THREE.Matrix4();
  cells.forEach((flat, i) => {
    const at = cellOf(scene.shape, flat).map((c, a) => scene.origin_m[a]! + (c + 0.5) * side);
    mesh.setMatrixAt(i, matrix.setPosition(at[0]!, at[1]!, at[2]!));
    mesh.setColorAt(i, new THREE.Color(...scene.classes[labels[flat]!]!.colour.map((c) => c / 255)));
  });
  const world = new THREE.Scene().add(mesh);
  const camera = new THREE.PerspectiveCamera((FIELD * 180) / Math.PI, innerWidth / innerHeight, 0.1, 1000);
  camera.up.set(0, 0, 1);
  return (orbit) => {
    camera.position.set(...eyeOf(orbit));
    camera.lookAt(...orbit.target);
    renderer.render(world, camera);
    const gl = renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits for the picture
  };
}
