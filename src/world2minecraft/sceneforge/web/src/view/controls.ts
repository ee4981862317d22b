// Mouse, pen and touch turn the camera: drag orbits, Shift+drag and middle drag pan, the wheel
// zooms to what is under the pointer, right drag orbits whatever the tool. Two fingers pan and zoom.

import { panned, turned, zoomed, type Orbit } from "./camera";
import type { Vec3 } from "../wire";

export interface CameraHolder {
  orbit: Orbit;
  /** The point of the scene under a pixel, in metres, for zooming to it. */
  pointAt(x: number, y: number): Vec3 | null;
}

const TURN = Math.PI; // radians for a drag over the view's height
const WHEEL = 0.0013;

export class Controls {
  /** Tools set this: whether a left drag that starts here is theirs. */
  claims: (event: PointerEvent) => boolean = () => false;
  private drag: { id: number; x: number; y: number; pan: boolean } | null = null;
  private readonly fingers = new Map<number, { x: number; y: number }>();
  private readonly ends: (() => void)[] = [];

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly holder: CameraHolder,
  ) {
    this.on("pointerdown", (event) => this.down(event));
    this.on("pointermove", (event) => this.move(event));
    this.on("pointerup", (event) => this.up(event));
    this.on("pointercancel", (event) => this.up(event));
    this.on("wheel", (event) => this.wheel(event), { passive: false });
    this.on("contextmenu", (event) => event.preventDefault());
  }

  get dragging(): boolean {
    return this.drag !== null;
  }

  dispose(): void {
    for (const end of this.ends) end();
  }

  private on<K extends keyof HTMLElementEventMap>(
    type: K,
    call: (event: HTMLElementEventMap[K]) => void,
    options?: AddEventListenerOptions,
  ): void {
    this.canvas.addEventListener(type, call, options);
    this.ends.push(() => this.canvas.removeEventListener(type, call, options));
  }

  private down(event: PointerEvent): void {
    if (event.pointerType === "touch") this.fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (this.drag || event.button > 2) return;
    if (event.button === 0 && this.claims(event)) return;
    const pan = event.button === 1 || (event.button === 0 && event.shiftKey);
    this.drag = { id: event.pointerId, x: event.clientX, y: event.clientY, pan };
    try {
      this.canvas.setPointerCapture(event.pointerId);
    } catch {
      // The pointer is gone already, as for events that a script made.
    }
    if (event.button === 1) event.preventDefault();
  }

  private move(event: PointerEvent): void {
    if (this.drag && this.fingers.size === 2 && this.fingers.has(event.pointerId)) return this.pinch(event);
    const drag = this.drag;
    if (!drag || event.pointerId !== drag.id) return;
    const dx = (event.clientX - drag.x) / this.canvas.clientHeight;
    const dy = (event.clientY - drag.y) / this.canvas.clientHeight;
    drag.x = event.clientX;
    drag.y = event.clientY;
    const { orbit } = this.holder;
    this.holder.orbit = drag.pan ? panned(orbit, dx, -dy) : turned(orbit, -dx * TURN, dy * TURN);
  }

  private up(event: PointerEvent): void {
    const paired = this.fingers.size === 2 && this.fingers.has(event.pointerId);
    this.fingers.delete(event.pointerId);
    if (event.pointerId === this.drag?.id || paired) this.drag = null;
  }

  /** Two fingers: their middle pans, their distance zooms to what is under it. */
  private pinch(event: PointerEvent): void {
    const old = this.fingers.get(event.pointerId)!;
    const [otherId, other] = [...this.fingers].find(([id]) => id !== event.pointerId)!;
    const now = { x: event.clientX, y: event.clientY };
    this.fingers.set(event.pointerId, now);
    this.fingers.set(otherId, other);
    const box = this.canvas.getBoundingClientRect();
    const apart = (a: { x: number; y: number }): number => Math.max(Math.hypot(a.x - other.x, a.y - other.y), 1);
    const moved = panned(this.holder.orbit, (now.x - old.x) / 2 / box.height, (old.y - now.y) / 2 / box.height);
    const middle = this.holder.pointAt((now.x + other.x) / 2 - box.left, (now.y + other.y) / 2 - box.top);
    this.holder.orbit = zoomed(moved, apart(old) / apart(now), middle);
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    if (event.ctrlKey && !this.isPinch(event)) return; // Ctrl+wheel sizes the brush.
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 33 : 1;
    const delta = Math.max(-240, Math.min(240, event.deltaY * lines));
    const box = this.canvas.getBoundingClientRect();
    const point = this.holder.pointAt(event.clientX - box.left, event.clientY - box.top);
    this.holder.orbit = zoomed(this.holder.orbit, Math.exp(delta * WHEEL), point);
  }

  /** Browsers send a pinch as Ctrl+wheel in small broken steps. */
  private isPinch(event: WheelEvent): boolean {
    return event.deltaMode === WheelEvent.DOM_DELTA_PIXEL && !Number.isInteger(event.deltaY);
  }
}
