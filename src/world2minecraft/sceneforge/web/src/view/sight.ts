// Where the picture is seen from: an orbit, a flight between two, or a pose that a photo or a
// walker gives. Turns pixels into rays and points into pixels.

import * as THREE from "three";

import { axesOf, between, eyeOf, FIELD, halfHeight, plus, rayAt, type Orbit } from "./camera";
import type { Vec3 } from "../wire";

/** A camera that stands where it is told: of a photo, or of someone who walks. */
export interface Pose {
  position: Vec3; // metres
  forward: Vec3; // unit
  up: Vec3; // unit
  field: number; // radians, vertical
}

const FLIGHT_MS = 260;
const FARTHEST_M = 1000;

export class Sight {
  private orbiting: Orbit;
  private flight: { from: Orbit; to: Orbit; start: number; lasts: number } | null = null;
  private posed: Pose | null = null;
  private wide = 1;
  private tall = 1;
  private readonly perspective = new THREE.PerspectiveCamera();
  private readonly parallel = new THREE.OrthographicCamera();

  constructor(start: Orbit) {
    this.orbiting = start;
  }

  get orbit(): Orbit {
    return this.orbiting;
  }

  set orbit(orbit: Orbit) {
    this.flight = null;
    this.orbiting = orbit;
  }

  get pose(): Pose | null {
    return this.posed;
  }

  set pose(pose: Pose | null) {
    this.flight = null;
    this.posed = pose;
  }

  /** Where the orbit is, or where it is flying to. */
  get goal(): Orbit {
    return this.flight?.to ?? this.orbiting;
  }

  get flying(): boolean {
    return this.flight !== null;
  }

  get aspect(): number {
    return this.wide / this.tall;
  }

  get isParallel(): boolean {
    return !this.posed && this.orbiting.ortho;
  }

  get eye(): Vec3 {
    return this.posed?.position ?? eyeOf(this.orbiting);
  }

  /** Unit vectors of the camera; `back` points from what it looks at to it. */
  get axes(): { back: Vec3; right: Vec3; up: Vec3 } {
    if (!this.posed) return axesOf(this.orbiting);
    const { forward, up } = this.posed;
    const right = new THREE.Vector3(...forward).cross(new THREE.Vector3(...up)).normalize();
    const level = right.clone().cross(new THREE.Vector3(...forward)).normalize();
    return { back: forward.map((f) => -f) as Vec3, right: right.toArray(), up: level.toArray() };
  }

  /** How many pixels a metre at a distance is large. */
  pixels(distance: number): number {
    const tan = Math.tan((this.posed?.field ?? FIELD) / 2);
    return this.tall / (2 * (this.isParallel ? halfHeight(this.orbiting) : tan * distance));
  }

  resize(wide: number, tall: number): void {
    this.wide = Math.max(wide, 1);
    this.tall = Math.max(tall, 1);
  }

  fly(to: Orbit, now: number, calm: boolean, lasts = FLIGHT_MS): void {
    this.flight = calm ? null : { from: { ...this.orbiting, ortho: to.ortho }, to, start: now, lasts };
    if (calm) this.orbiting = to;
  }

  /** Go on with the flight. */
  step(now: number): void {
    if (!this.flight) return;
    const { from, to, start, lasts } = this.flight;
    const share = Math.min(Math.max((now - start) / lasts, 0), 1);
    this.orbiting = between(from, to, share);
    if (share === 1) this.flight = null;
  }

  ray(x: number, y: number): { from: Vec3; direction: Vec3 } {
    if (!this.posed) return rayAt(this.orbiting, x, y, this.wide, this.tall);
    const { back, right, up } = this.axes;
    const tan = Math.tan(this.posed.field / 2);
    const a = ((2 * x) / this.wide - 1) * this.aspect * tan;
    const b = (1 - (2 * y) / this.tall) * tan;
    const direction = plus(plus(plus([0, 0, 0], back, -1), right, a), up, b);
    return { from: this.posed.position, direction };
  }

  /** Where a point in metres is, in pixels from the top left; null: behind the camera. */
  project(point: Vec3): [number, number] | null {
    return this.projector()(point);
  }

  /** As project, for many points. */
  projector(): (point: Vec3) => [number, number] | null {
    const { eye, isParallel, wide, tall } = this;
    const { back, right, up } = this.axes;
    const unit = this.pixels(1);
    return (point) => {
      const [x, y, z] = [point[0] - eye[0], point[1] - eye[1], point[2] - eye[2]];
      const deep = -(x * back[0] + y * back[1] + z * back[2]);
      if (!isParallel && deep <= 1e-6) return null;
      const scale = isParallel ? unit : unit / deep;
      const across = x * right[0] + y * right[1] + z * right[2];
      return [wide / 2 + across * scale, tall / 2 - (x * up[0] + y * up[1] + z * up[2]) * scale];
    };
  }

  /** three.js's camera, placed. */
  camera(): THREE.PerspectiveCamera | THREE.OrthographicCamera {
    const { back, right, up } = this.axes;
    const camera = this.isParallel ? this.parallel : this.perspective;
    if (camera === this.perspective) {
      this.perspective.fov = ((this.posed?.field ?? FIELD) * 180) / Math.PI;
      this.perspective.aspect = this.aspect;
      this.perspective.near = this.posed ? 0.02 : Math.max(this.orbiting.distance / 200, 0.02);
      this.perspective.far = (this.posed ? 0 : this.orbiting.distance) + FARTHEST_M;
    } else {
      const half = halfHeight(this.orbiting);
      Object.assign(this.parallel, { top: half, bottom: -half, near: -FARTHEST_M, far: FARTHEST_M });
      Object.assign(this.parallel, { left: -half * this.aspect, right: half * this.aspect });
    }
    const axes = [right, up, back].map((axis) => new THREE.Vector3(...axis));
    camera.matrixAutoUpdate = false;
    camera.matrix.makeBasis(axes[0]!, axes[1]!, axes[2]!).setPosition(...this.eye);
    camera.matrix.decompose(camera.position, camera.quaternion, camera.scale);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld(true);
    return camera;
  }
}
